#pragma once

#include <cmath>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "fit/measured/measured.h"
#include "fit/report/overview.h"
#include "fit/result/result.h"

// What the tests of the report share: an example to draw, and ways to ask a page what it is.
namespace likeness::fit {

brdf::Callisto<double> example_model();

// A Callisto model as if it had been measured, with data up to a limit of theta_i and theta_o.
class SyntheticMaterial : public measured::Material {
 public:
  SyntheticMaterial(const brdf::Callisto<double>& model, double limit_deg)
      : model_(model), cos_limit_(std::cos(limit_deg * 3.14159265358979 / 180)) {}
  bool evaluate(const measured::Direction& l, const measured::Direction& v, measured::Rgb& f) const override {
    if (l.z < cos_limit_ || v.z < cos_limit_) return false;
    f = model_.eval(l, v);
    return true;
  }
  void for_each_sample(const std::function<void(const measured::Sample&)>&) const override {}
  measured::Coverage coverage() const override { return {1458000, 1096416, 361000, 584}; }
  measured::Format format() const override { return measured::Format::kMerl; }

 private:
  brdf::Callisto<double> model_;
  double cos_limit_;
};

// A fit of example_model() with two baselines, one hand set and every kind of mark.
Result example_result();

// Three flat materials (errors 1, 2 and 3 % but for "far": 4 %) and one with a bright Fresnel edge.
std::vector<OverviewRow> example_rows();

// The first place where tags do not nest or an attribute does not end; empty if there is none.
std::string first_tag_error(const std::string& page);

// The first src, href or url() that is neither inside the page nor relative; empty if there is none.
std::string first_outside_reference(const std::string& page);

// What chromium says of a page in a window of that width (a frame, because its own window is at least 500 wide).
struct BrowserAnswer {
  bool loaded = false;
  int inner_width = 0, scroll_width = 0, images = 0, broken_images = 0;
  std::string first_card, first_card_by_largest_error;  // of an overview
  std::string dom;
};
bool browser_is_there();
BrowserAnswer ask_browser(const std::string& page, int width);

// The size of a screenshot's PNG; kept as report_WIDTH.png in the folder LIKENESS_SCREENSHOTS, if that is set.
std::size_t screenshot_bytes(const std::string& page, int width);

}  // namespace likeness::fit
