#include "fit/report/overview.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "fit/slice/slice.h"
#include "render/image/write.h"
#include "render/page/html.h"

namespace likeness::fit {

using page::base64;
using page::escape;
using page::fixed;
using page::number;
using page::page_foot;
using page::page_head;
namespace {

double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return n % 2 ? values[n / 2] : (values[n / 2 - 1] + values[n / 2]) / 2;
}

// A path as a relative URL: every byte but the unreserved ones and '/' is percent-encoded (RFC 3986), so that a
// name can neither name a scheme nor end the attribute.
std::string relative_url(const std::string& path) {
  constexpr std::string_view kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-._~/";
  constexpr std::string_view kHex = "0123456789ABCDEF";
  std::string out;
  for (const char c : path) {
    const auto byte = static_cast<unsigned char>(c);
    if (kPlain.find(c) != std::string_view::npos) out += c;
    else (out += '%') += {kHex[byte >> 4], kHex[byte & 15]};
  }
  while (out.starts_with("//")) out.erase(0, 1);  // not another host
  return out;
}

std::string card(const OverviewRow& row) {
  const bool is_file = row.thumbnail_png.find('.') != std::string::npos;
  const std::string picture =
      is_file ? relative_url(row.thumbnail_png) : "data:image/png;base64," + escape(row.thumbnail_png);
  return "<li data-error=\"" + number(row.metrics.slice_error_pct, 8) + "\" data-log=\"" +
         number(row.metrics.slice_log_rms, 8) + "\" data-table=\"" + number(row.metrics.log_rms_3d, 8) +
         "\" data-name=\"" + escape(row.material) + "\"><a href=\"" + relative_url(row.report_href) +
         "\"><img class=\"pixels\" width=\"90\" height=\"90\" src=\"" + picture + "\" alt=\"" +
         escape("Measured slice of " + row.material) + "\"><b>" + escape(row.material) +
         "</b><span class=\"quiet\">error " + fixed(row.metrics.slice_error_pct, 2) + " %<br>log RMS " +
         fixed(row.metrics.slice_log_rms, 4) + "<br>" + escape(row.label) + "</span></a></li>\n";
}

constexpr std::string_view kSortScript = R"js(<script>
document.querySelector('.controls').hidden = false;
document.getElementById('order').addEventListener('change', function (event) {
  var by = event.target.value, sign = by.charAt(0) === '-' ? -1 : 1, key = by.replace('-', '');
  document.querySelectorAll('.cards').forEach(function (list) {
    Array.from(list.children).sort(function (a, b) {
      var x = a.dataset[key], y = b.dataset[key];
      return sign * (key === 'name' ? x.localeCompare(y) : x - y);
    }).forEach(function (card) { list.appendChild(card); });
  });
});
</script>
)js";

}  // namespace

std::string slice_thumbnail(const measured::Material& material, double cut_deg) {
  const SlicePicture slice = slice_of(material);
  return base64(image::png_bytes(slice_picture(slice, slice_exposure(slice, cut_deg))));
}

std::string overview_html(const std::vector<OverviewRow>& rows, const std::vector<FailedFile>& failed) {
  std::map<std::string, std::vector<const OverviewRow*>> groups;
  std::vector<double> errors, logs;
  for (const OverviewRow& row : rows) {
    groups[row.pattern.group].push_back(&row);
    errors.push_back(row.metrics.slice_error_pct);
    logs.push_back(row.metrics.slice_log_rms);
  }
  const auto plural = [](std::size_t n, std::string_view word) {
    return std::to_string(n) + " " + std::string(word) + (n == 1 ? "" : "s");
  };
  std::string out = page_head("Overview: " + plural(rows.size(), "material")) + "<header>\n<h1>" +
                    plural(rows.size(), "material") + " fitted</h1>\n<p class=\"verdict\">";
  if (!rows.empty())
    out += "Slice error: mean " + fixed(mean(errors), 2) + " %, median " + fixed(median(errors), 2) + " %, worst " +
           fixed(*std::max_element(errors.begin(), errors.end()), 2) + " %. Slice log RMS: mean " +
           fixed(mean(logs), 4) + ", median " + fixed(median(logs), 4) + ". ";
  out += failed.empty() ? "No file failed."
                        : "<a href=\"#failed\">" + plural(failed.size(), "file") + " could not be fitted</a>.";
  out +=
      "</p>\n<p class=\"quiet\">Each picture is the measured slice: half-angle to the normal (θh) across, to the light "
      "(θd) "
      "up, 0 to 90°; mirror reflection at the left edge, grazing light at the top, light sent back at the right. "
      "Brightness is set for each picture by itself; hatched: no data. Groups follow the fitted pattern of the slice: "
      "how "
      "its top, right edge and top right corner compare with its middle. Within a group the nearest fit comes "
      "first.</p>\n";
  out +=
      "<p class=\"controls\" hidden><label>Sort each group by <select id=\"order\"><option value=\"error\">slice "
      "error, "
      "smallest first</option><option value=\"-error\">slice error, largest first</option><option value=\"log\">slice "
      "log "
      "RMS, smallest first</option><option value=\"table\">whole-table log RMS, smallest first</option><option "
      "value=\"name\">name</option></select></label></p>\n</header>\n<main>\n";
  std::vector<std::pair<std::string, std::vector<const OverviewRow*>>> ordered(groups.begin(), groups.end());
  std::stable_sort(ordered.begin(), ordered.end(),
                   [](const auto& a, const auto& b) { return a.second.size() > b.second.size(); });
  for (auto& [group, members] : ordered) {
    std::stable_sort(members.begin(), members.end(), [](const OverviewRow* a, const OverviewRow* b) {
      const double x = a->metrics.slice_error_pct, y = b->metrics.slice_error_pct;
      return x != y ? x < y : a->material < b->material;
    });
    out += "<section><h2>" + escape(group.empty() ? "Pattern not determined" : group) + " <small>(" +
           std::to_string(members.size()) + ")</small></h2>\n<ul class=\"cards\">\n";
    for (const OverviewRow* row : members) out += card(*row);
    out += "</ul></section>\n";
  }
  if (!failed.empty()) {
    out += "<section id=\"failed\"><h2>Could not be fitted</h2>\n<ul>\n";
    for (const FailedFile& file : failed)
      out += "<li><code>" + escape(file.source) + "</code><br>" + escape(file.message) + "</li>\n";
    out += "</ul></section>\n";
  }
  return out + "</main>\n" + (rows.empty() ? "" : std::string(kSortScript)) + page_foot();
}

}  // namespace likeness::fit
