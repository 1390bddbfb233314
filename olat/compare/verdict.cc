#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "olat/compare/compare.h"
#include "render/files/files.h"

namespace likeness::olat_compare {
namespace {

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

metric::Summary total(const std::vector<const metric::Summary*>& summaries) {
  metric::Summary out;
  double pixels = 0, sum = 0, squares = 0;
  std::vector<double> medians, p95s;
  for (const metric::Summary* s : summaries) {
    const auto n = static_cast<double>(s->pixels);
    out.pixels += s->pixels;
    out.not_finite += s->not_finite;
    if (s->pixels == 0) continue;
    pixels += n;
    sum += n * s->mean;
    squares += n * s->rms * s->rms;
    medians.push_back(s->median);
    p95s.push_back(s->p95);
    out.largest = std::max(out.largest, s->largest);
  }
  if (medians.empty()) return out;
  out.mean = sum / pixels;
  out.rms = std::sqrt(squares / pixels);
  out.median = median(medians);
  out.p95 = median(p95s);
  return out;
}

Limit limit_of(std::string_view text) {
  Limit limit;
  const std::size_t equals = text.find('=');
  const std::string number(equals == text.npos ? text : text.substr(equals + 1));
  if (equals != text.npos) {
    const std::string_view name = text.substr(0, equals);
    const std::size_t dot = name.find('.');
    limit.metric = metric::metric_of(name.substr(0, dot));
    if (dot != name.npos) {
      std::array<std::string_view, metric::kStatistics.size()> ids{};
      for (std::size_t k = 0; k < ids.size(); ++k) ids[k] = metric::kStatistics[k].id;
      const auto at = std::ranges::find(ids, name.substr(dot + 1));
      if (at == ids.end())
        throw files::UsageError("unknown statistic " + files::in_quotes(name.substr(dot + 1)) +
                                "; there are mean, median, p95, rms, largest");
      limit.statistic = static_cast<std::size_t>(at - ids.begin());
    }
  }
  char* end = nullptr;
  limit.most = std::strtod(number.c_str(), &end);
  if (number.empty() || *end != '\0' || !(limit.most >= 0) || !std::isfinite(limit.most))
    throw files::UsageError("limit " + files::in_quotes(text) +
                            " is not a number of at least 0, alone or as METRIC.STATISTIC=NUMBER (stops.p95=0.5)");
  return limit;
}

int exit_code_of(const Comparison& comparison, const std::vector<Limit>& fail, const std::vector<Limit>& warn) {
  int code = kWithin;
  std::size_t compared = 0;
  const auto passes = [&](const Row& row, const Limit& limit) {
    for (std::size_t k = 0; k < comparison.metrics.size(); ++k)
      if (comparison.metrics[k] == limit.metric)
        return std::abs(row.summaries[k].*metric::kStatistics[limit.statistic].value) > limit.most;
    return false;
  };
  for (const Row& row : comparison.rows) {
    if (row.state == State::kOtherSize) code = std::max<int>(code, kSizeDiffers);
    if (row.state == State::kUnreadable) code = std::max<int>(code, kFileError);
    if (row.state != State::kCompared) continue;
    ++compared;
    for (const Limit& limit : fail)
      if (passes(row, limit)) code = std::max<int>(code, kFail);
    for (const Limit& limit : warn)
      if (passes(row, limit)) code = std::max<int>(code, kWarn);
  }
  return compared == 0 && code < kSizeDiffers ? static_cast<int>(kFileError) : code;
}

}  // namespace likeness::olat_compare
