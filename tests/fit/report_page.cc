#include "tests/fit/report_page.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

#include "render/files/files.h"
#include "render/page/html.h"

namespace likeness::fit {

using page::escape;
namespace {

Metrics example_metrics(double error, double log_rms) {
  Metrics m;
  m.slice_error_pct = error;
  m.slice_log_rms = log_rms;
  m.log_rms_3d = 1.7 * log_rms;
  m.albedo_reference = {0.51, 0.081, 0.062};
  m.albedo_model = {0.51 + log_rms, 0.081 - log_rms / 3, 0.062 + log_rms / 5};
  m.sphere_psnr = 46 - 2 * error;
  m.sphere_ssim = 1 - log_rms / 10;
  m.slice_samples = 7012, m.slice_grid = 8100;
  m.table_samples = 903311, m.table_stored = 1458000;
  return m;
}

Candidate candidate(const std::string& label, const brdf::AnyBrdf& model, double error, double log_rms) {
  Candidate c;
  c.label = label;
  c.brdf = model;
  c.metrics = example_metrics(error, log_rms);
  c.loss = log_rms * log_rms;
  return c;
}

class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "likeness_report_XXXXXX").string();
    path = mkdtemp(name.data());
  }
  ~TemporaryFolder() {
    std::error_code error;
    std::filesystem::remove_all(path, error);
  }
  std::filesystem::path path;
};

// Runs chromium on the page in a frame of that width; `action` is its --dump-dom or --screenshot. The frame's script
// asks the questions when everything is loaded. Returns what chromium printed.
std::string run_browser(const TemporaryFolder& folder, const std::string& page, int width, const std::string& action) {
  constexpr const char* kQuestions = R"js(<script>
window.onload = function () {
  var d = document.querySelector('iframe').contentDocument, w = d.defaultView;
  var images = Array.from(d.images), card = function () { var b = d.querySelector('.cards b'); return b ? b.textContent : ''; };
  var answer = ['answer', w.innerWidth, d.documentElement.scrollWidth, images.length,
                images.filter(function (i) { return !(i.complete && i.naturalWidth > 0); }).length, card() || '-'];
  var order = d.getElementById('order');
  if (order) { order.value = '-error'; order.dispatchEvent(new w.Event('change')); }
  answer.push(card() || '-', 'end');
  document.body.setAttribute('data-answer', answer.join(' '));
};
</script>)js";
  files::write_whole(
      folder.path / "frame.html",
      std::string("<!DOCTYPE html><html><head><meta charset=\"utf-8\"><style>body{margin:0}iframe{border:0;"
                  "display:block}</style>") +
          kQuestions + "</head><body><iframe width=\"" + std::to_string(width) + "\" height=\"1600\" srcdoc=\"" +
          escape(page) + "\"></iframe></body></html>");
  const std::string command =
      "timeout 60 '" LIKENESS_CHROMIUM
      "' --headless --no-sandbox --disable-gpu --disable-quic --no-first-run "
      "--disable-background-networking --disable-component-update --disable-sync --hide-scrollbars --user-data-dir='" +
      (folder.path / "profile").string() + "' --window-size=" + std::to_string(std::max(width, 600)) + ",1600 " +
      action + " 'file://" + (folder.path / "frame.html").string() + "' > '" + (folder.path / "out").string() +
      "' 2>/dev/null";
  if (std::system(command.c_str()) != 0) return "";
  return files::read_whole(folder.path / "out", 64 << 20);
}

}  // namespace

brdf::Callisto<double> example_model() {
  brdf::Callisto<double> m;
  m.base_color = {0.55, 0.06, 0.04};
  m.roughness = 0.28;
  m.specular = 0.6;
  m.diffuse_fresnel = 2.2;
  m.retroreflection = 1.8;
  m.smooth_terminator = 0.5;
  return m;
}

Result example_result() {
  Result r;
  r.material = "specular-red-phenolic";
  r.source = "data/specular-red-phenolic.binary";
  r.sha256 = std::string(64, 'a');
  r.coverage = {1458000, 1096416, 361000, 584};
  brdf::Callisto<double> model = example_model();
  model.base_color = {0.53, 0.064, 0.043};
  model.smooth_terminator_length = 1;
  r.best = candidate("Callisto, full tier", model, 1.23, 0.0093);
  r.best.cpu_seconds = 0.52;
  r.best.best_start = 4;
  for (int i = 0; i < 30; ++i) r.best.convergence.push_back({i, 2.3e-4 + 0.2 * std::exp(-0.45 * i)});
  for (int i = 0; i < 12; ++i) r.best.start_losses.push_back(2.3e-4 * (1 + (i * 7 % 12) * 0.3));
  const auto values = brdf::channels_of(model);
  std::size_t at = 0;
  for (const brdf::Parameter& row : brdf::Callisto<double>::kParameters)
    for (int c = 0; c < row.channels; ++c) {
      Estimate e;
      e.name = row.name;
      e.channel = row.channels == 3 ? c : -1;
      e.value = values[at++];
      e.sigma = 0.013;
      e.fitted = true;
      e.at_bound = e.value == row.range.low || e.value == row.range.high;
      if (row.name == "retroreflection_tint") {
        e.matters = false;
        e.sigma = std::numeric_limits<double>::quiet_NaN();
        e.why = "the mask is never reached";
      }
      r.best.estimates.push_back(e);
    }
  brdf::Ggx<double> ggx;
  r.baselines.push_back(candidate("Lambert + GGX", ggx, 6.3, 0.052));
  r.baselines.push_back(candidate("Disney 2012", brdf::Disney2012<double>{}, 5.1, 0.041));
  r.hand_set = candidate("Callisto, the talk's hand set", example_model(), 2.3, 0.034);
  r.pattern = {1.2, 0.4, -0.7, "Fresnel brighter, retroreflection brighter, dark corner"};
  r.timing = {0.11, 0.52, 0.31, 0.12, 0.09};
  return r;
}

std::vector<OverviewRow> example_rows() {
  const std::string thumbnail = slice_thumbnail(SyntheticMaterial(example_model(), 88), 80);
  const auto row = [&](const std::string& name, double error, const std::string& group) {
    return OverviewRow{name,      "Callisto, full tier",      example_metrics(error, 0.01 * error), {0, 0, 0, group},
                       thumbnail, "a \"b\"/" + name + ".html"};
  };
  return {row("far", 4, "flat"), row("near", 1, "flat"), row("middle", 2, "flat"), row("other", 3, "Fresnel brighter")};
}

std::string first_tag_error(const std::string& page) {
  std::vector<std::string> open;
  for (std::size_t i = 0; i < page.size();) {
    if (page[i] != '<') {
      ++i;
      continue;
    }
    std::size_t end = i + 1;
    for (char quote = 0; end < page.size() && (quote || page[end] != '>'); ++end)
      if (quote ? page[end] == quote : page[end] == '"') quote = quote ? '\0' : page[end];
    if (end == page.size()) return "a tag does not end: " + page.substr(i, 60);
    const std::string tag = page.substr(i + 1, end - i - 1);
    i = end + 1;
    if (tag.starts_with("!DOCTYPE")) continue;
    const std::string name = tag.substr(tag[0] == '/' ? 1 : 0, tag.find_first_of(" /\n", 1) - (tag[0] == '/' ? 1 : 0));
    if (name.empty() || !std::isalpha(static_cast<unsigned char>(name[0]))) return "a stray <: " + tag.substr(0, 60);
    if (tag[0] == '/') {
      if (open.empty() || open.back() != name)
        return "</" + name + "> closes " + (open.empty() ? "nothing" : open.back());
      open.pop_back();
    } else if (tag.back() != '/' && name != "meta" && name != "img" && name != "br") {
      open.push_back(name);
      if (name == "style" || name == "script") i = page.find("</" + name, i);
    }
  }
  return open.empty() ? "" : "<" + open.back() + "> is not closed";
}

std::string first_outside_reference(const std::string& page) {
  for (const std::string mark : {"src=\"", "href=\"", "url(", "@import"})
    for (std::size_t at = page.find(mark); at != std::string::npos; at = page.find(mark, at + 1)) {
      const std::string target = page.substr(at + mark.size(), 60);
      const std::size_t colon = target.find(':'), quote = target.find_first_of("\")");
      const bool has_scheme = colon != std::string::npos && colon < quote;
      if (mark == "@import" || target.starts_with("//") ||
          (has_scheme && !target.starts_with("data:image/png;base64,")))
        return mark + target;
    }
  return page.find("http:") == std::string::npos && page.find("https:") == std::string::npos ? "" : "an http address";
}

bool browser_is_there() { return *LIKENESS_CHROMIUM != '\0'; }

BrowserAnswer ask_browser(const std::string& page, int width) {
  const TemporaryFolder folder;
  BrowserAnswer answer;
  answer.dom = run_browser(folder, page, width, "--dump-dom");
  const std::size_t at = answer.dom.find("data-answer=\"answer ");
  if (at == std::string::npos) return answer;
  std::istringstream words(answer.dom.substr(at + 20, 400));
  answer.loaded = static_cast<bool>(words >> answer.inner_width >> answer.scroll_width >> answer.images >>
                                    answer.broken_images >> answer.first_card >> answer.first_card_by_largest_error);
  return answer;
}

std::size_t screenshot_bytes(const std::string& page, int width) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.path / "screen.png";
  run_browser(folder, page, width, "--screenshot='" + file.string() + "'");
  if (!std::filesystem::exists(file)) return 0;
  if (const char* keep = std::getenv("LIKENESS_SCREENSHOTS"); keep && *keep)
    files::write_whole(std::filesystem::path(keep) / ("report_" + std::to_string(width) + ".png"),
                       files::read_whole(file, 64 << 20));
  return std::filesystem::file_size(file);
}

}  // namespace likeness::fit
