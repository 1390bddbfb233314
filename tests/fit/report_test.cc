#include "fit/report/report.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "fit/report/overview.h"
#include "fit/report/spheres.h"
#include "fit/slice/slice.h"
#include "render/image/tone_curve.h"
#include "render/page/html.h"
#include "tests/fit/report_page.h"

namespace likeness::fit {

using page::base64;
using page::escape;
using page::fixed;
using page::number;
namespace {

using Lambert = brdf::Lambert<double>;

constexpr double kDegree = std::numbers::pi / 180;

Lambert lambert(double r, double g, double b) {
  Lambert model;
  model.base_color = {r, g, b};
  return model;
}

TEST(Slice, PixelsAreTheModelAtTheAnglesOfTheirCentres) {
  const brdf::Callisto<double> model = example_model();
  const SlicePicture slice = slice_of(brdf::AnyBrdf(model));
  for (const auto& [column, row] : {std::pair{0, 0}, {89, 0}, {0, 89}, {89, 89}, {17, 60}}) {
    const double h = (column + 0.5) * kDegree, d = (89.5 - row) * kDegree;
    const measured::Direction l{std::sin(h) * std::cos(d), std::sin(d), std::cos(h) * std::cos(d)};
    const measured::Direction v{l.x, -l.y, l.z};
    const measured::Rgb f = model.eval(l, v);
    const auto pixel = slice.f.at(column, row);
    EXPECT_NEAR(pixel[0], f.r, 1e-5 * f.r + 1e-7) << column << ", " << row;  // float, and a peak's 1 - cos
    EXPECT_NEAR(pixel[2], f.b, 1e-5 * f.b + 1e-7) << column << ", " << row;  // the same
    EXPECT_TRUE(slice.valid_at(column, row));
  }
}

TEST(Slice, OfAMaterialMarksWhatItHasNoDataFor) {
  const SyntheticMaterial material(example_model(), 60);
  const SlicePicture slice = slice_of(material);
  EXPECT_TRUE(slice.valid_at(20, 60));
  EXPECT_FALSE(slice.valid_at(80, 60));  // cos 80.5 cos 29.5 deg is that of 81.8 deg
  const image::DisplayPicture picture = slice_picture(slice, 0);
  EXPECT_EQ(picture.at(80, 60)[0], no_data_color(80, 60)[0]);
  EXPECT_EQ(picture.at(20, 60)[0], image::srgb_encode8(slice.f.at(20, 60)[0]));
}

TEST(Slice, CutIsOnTheAnglesOfLightAndView) {
  EXPECT_TRUE(within_cut(0, 10, 80));    // theta_h 0.5, theta_d 79.5
  EXPECT_FALSE(within_cut(0, 9, 80));    // theta_d 80.5
  EXPECT_FALSE(within_cut(75, 14, 80));  // cos 75.5 cos 75.5 is that of 86.4 deg
}

TEST(Difference, IsPositiveWhereTheModelIsBrighterAndCountsStops) {
  const SlicePicture dark = slice_of(brdf::AnyBrdf(lambert(0.2, 0.2, 0.2)));
  const SlicePicture bright = slice_of(brdf::AnyBrdf(lambert(0.4, 0.4, 0.4)));
  EXPECT_NEAR(difference_in_stops(dark, bright, 80)[50 * kSliceSize + 5], 1, 1e-6);    // float
  EXPECT_NEAR(difference_in_stops(bright, dark, 80)[50 * kSliceSize + 5], -1, 1e-6);   // float
  EXPECT_NEAR(median_difference(difference_in_stops(bright, dark, 80)), 1, 1e-6);      // float
  EXPECT_TRUE(std::isnan(difference_in_stops(dark, bright, 80)[0 * kSliceSize + 5]));  // beyond the cut
}

TEST(Difference, HoldsDarkValuesAtTheDarkest) {
  const SlicePicture black = slice_of(brdf::AnyBrdf(lambert(0, 0, 0)));
  const double four = 4 * kDarkest * std::numbers::pi;
  const SlicePicture dim = slice_of(brdf::AnyBrdf(lambert(four, four, four)));
  EXPECT_NEAR(difference_in_stops(black, dim, 80)[50 * kSliceSize + 5], 2, 1e-5);  // float
  EXPECT_EQ(difference_in_stops(black, black, 80)[50 * kSliceSize + 5], 0);
}

TEST(Difference, ScaleIsBlueBelowWhiteAtAndOrangeAboveEqual) {
  EXPECT_EQ(difference_color(0), (Color8{247, 247, 247}));
  EXPECT_EQ(difference_color(-kStopsRange), (Color8{5, 48, 97}));
  EXPECT_EQ(difference_color(kStopsRange), (Color8{127, 59, 8}));
  EXPECT_EQ(difference_color(100), difference_color(kStopsRange));
  for (const double stops : {0.25, 0.5, 1.0, 1.5, 2.0}) {
    EXPECT_GT(difference_color(stops)[0], difference_color(stops)[2]) << stops;
    EXPECT_LT(difference_color(-stops)[0], difference_color(-stops)[2]) << stops;
  }
}

TEST(Spheres, OfAWhiteLambertShowTheCosine) {
  const SpherePicture spheres = spheres_of(brdf::AnyBrdf(lambert(1, 0.5, 0)));
  const int middle = kSphereSize / 2;
  EXPECT_NEAR(spheres.radiance.at(middle, middle)[0], 1, 1e-4);    // half a pixel off the centre
  EXPECT_NEAR(spheres.radiance.at(middle, middle)[1], 0.5, 1e-4);  // the same
  const int x = kSphereSize + middle + 40;  // second sphere, lit from the right: cos_i is the normal's x
  EXPECT_NEAR(spheres.radiance.at(x, middle)[0], 40.5 / (0.47 * kSphereSize), 1e-5);  // float
  EXPECT_EQ(spheres.radiance.at(kSphereSize + middle - 40, middle)[0], 0);            // its unlit side
  const double a = 130 * kDegree, nx = 70.5 / (0.47 * kSphereSize), ny = 0.5 / (0.47 * kSphereSize);
  EXPECT_NEAR(spheres.radiance.at(2 * kSphereSize + middle + 70, middle)[0],
              nx * std::sin(a) + std::sqrt(1 - nx * nx - ny * ny) * std::cos(a), 1e-5);  // float
}

TEST(Spheres, AreTheModelAtTheDirectionsOfThePixel) {
  const brdf::Callisto<double> model = example_model();
  const SpherePicture spheres = spheres_of(brdf::AnyBrdf(model));
  const int x = 45, y = 20;  // of the second sphere's upper right quarter
  const double scale = 1 / (0.47 * kSphereSize), nx = (x + 0.5) * scale, ny = (y + 0.5) * scale,
               nz = std::sqrt(1 - nx * nx - ny * ny);
  // Isotropic: only the angles to the normal and between the directions count; the light is (1, 0, 0), the view (0, 0, 1).
  const double sin_i = std::sqrt(1 - nx * nx), sin_o = std::sqrt(1 - nz * nz), cos_phi = -nx * nz / (sin_i * sin_o);
  const measured::Rgb f = model.eval({sin_i, 0, nx}, {sin_o * cos_phi, sin_o * std::sqrt(1 - cos_phi * cos_phi), nz});
  const auto upper = spheres.radiance.at(kSphereSize + kSphereSize / 2 + x, kSphereSize / 2 - 1 - y);
  const auto lower = spheres.radiance.at(kSphereSize + kSphereSize / 2 + x, kSphereSize / 2 + y);
  EXPECT_NEAR(upper[0], std::numbers::pi * f.r * nx, 1e-5);  // float
  EXPECT_EQ(upper[0], lower[0]);
}

TEST(Spheres, GoOnWithTheLastDataNearTheHorizonAndHatchTheRest) {
  const SpherePicture to_82 = spheres_of(SyntheticMaterial(example_model(), 82));
  const SpherePicture to_60 = spheres_of(SyntheticMaterial(example_model(), 60));
  const int row = kSphereSize / 2, rim = kSphereSize / 2 + 74;  // 79.7 deg from the normal; 75.2 pixels are 90 deg
  EXPECT_EQ(to_82.valid[static_cast<std::size_t>(row * 3 * kSphereSize + rim + 1)], 1);
  EXPECT_EQ(to_60.valid[static_cast<std::size_t>(row * 3 * kSphereSize + rim)], 0);
  EXPECT_EQ(spheres_picture(to_60, 0).at(rim, row)[0], no_data_color(rim, row)[0]);
}

TEST(Exposure, BringsTheMedianNearestToItsTargetInWholeStops) {
  EXPECT_EQ(exposure_of_median({0.05, 0.01, 100}, 0.18, 6), 2);  // 0.2
  EXPECT_EQ(exposure_of_median({0.18}, 0.18, 6), 0);
  EXPECT_EQ(exposure_of_median({1e-9}, 0.18, 6), 6);
  EXPECT_EQ(exposure_of_median({}, 0.18, 6), 0);
}

TEST(Html, EscapesWhatHtmlReads) {
  EXPECT_EQ(escape("a<b & \"c\" 'd' > ü€"), "a&lt;b &amp; &quot;c&quot; &#39;d&#39; &gt; ü€");
  EXPECT_EQ(escape("x\xffy\xc3"), "x\xef\xbf\xbdy\xef\xbf\xbd");              // not UTF-8
  EXPECT_EQ(escape("\xed\xa0\x80"), "\xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbd");  // a surrogate
  EXPECT_EQ(escape(std::string("a\x01z", 3)), "a\xef\xbf\xbdz");
}

TEST(Html, EncodesBase64AsTheStandardsExamples) {  // RFC 4648, section 10
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64("\xff\xfe\xfd"), "//79");
}

TEST(Html, WritesNumbersWithTheDigitsAsked) {
  EXPECT_EQ(number(0), "0");
  EXPECT_EQ(number(1234.5), "1234");
  EXPECT_EQ(number(0.012345), "0.0123");
  EXPECT_EQ(number(1e-7), "1.00e-07");
  EXPECT_EQ(number(std::numeric_limits<double>::quiet_NaN()), "-");
  EXPECT_EQ(fixed(std::numeric_limits<double>::infinity(), 1), "∞");
}

TEST(Report, IsWellFormedAndNeedsNothingOutside) {
  const std::string page = report_html(example_result(), SyntheticMaterial(example_model(), 88));
  EXPECT_EQ(first_tag_error(page), "");
  EXPECT_EQ(first_outside_reference(page), "");
  EXPECT_EQ(page.find("<script"), std::string::npos);
  EXPECT_NE(page.find("<html lang=\"en\">"), std::string::npos);
  EXPECT_LT(page.size(), 3u << 20);
}

TEST(Report, EscapesEveryNameItIsGiven) {
  const std::string evil = "<b>&\"'é</b>";
  Result result = example_result();
  result.material = result.source = result.sha256 = result.best.label = result.pattern.group = evil;
  for (Candidate& baseline : result.baselines) baseline.label = evil;
  result.hand_set->label = evil;
  for (Estimate& estimate : result.best.estimates) estimate.matters = false, estimate.why = evil;
  const std::string page = report_html(result, SyntheticMaterial(example_model(), 88));
  EXPECT_EQ(first_tag_error(page), "");
  EXPECT_EQ(page.find(evil), std::string::npos);
  EXPECT_NE(page.find("<h1>&lt;b&gt;&amp;&quot;&#39;é&lt;/b&gt;</h1>"), std::string::npos);
}

TEST(Report, NamesEveryCandidateAndMarksTheBestOfEachMetric) {
  Result result = example_result();
  result.baselines[0].metrics.sphere_psnr = 60;
  const std::string page = report_html(result, SyntheticMaterial(example_model(), 88));
  for (const char* label : {"Callisto, full tier", "Lambert + GGX", "Disney 2012", "the talk&#39;s hand set"})
    EXPECT_NE(page.find(label), std::string::npos) << label;
  EXPECT_NE(page.find("<td class=\"n best\">1.23<"), std::string::npos);  // the lowest slice error
  EXPECT_NE(page.find("<td class=\"n best\">60.0<"), std::string::npos);  // the highest PSNR
  EXPECT_EQ(page.find("<td class=\"n best\">6.30<"), std::string::npos);
  for (const char* said : {"7012 of 8100 samples used (86.6 %)", "θo ≤ 80°", "90 × 90", "at upper bound",
                           "does not matter", "because the mask is never reached"})
    EXPECT_NE(page.find(said), std::string::npos) << said;
}

TEST(Report, SaysSoWhereAnotherModelIsNearer) {
  Result result = example_result();
  EXPECT_EQ(report_html(result, SyntheticMaterial(example_model(), 88)).find("is nearer; the fit"), std::string::npos);
  result.baselines[1].metrics.slice_error_pct = 0.5;
  EXPECT_NE(report_html(result, SyntheticMaterial(example_model(), 88)).find("<strong>Disney 2012</strong> is nearer"),
            std::string::npos);
}

TEST(Report, RepeatsTheCommandWithTheFileQuotedForAShell) {
  Result result = example_result();
  result.source = "my data/it's red.binary";
  EXPECT_EQ(command_line(result),
            "likeness fit 'my data/it'\\''s red.binary' --model callisto --tier full --on slice --cut "
            "80 --loss log");
  result.options.starts = 7;
  result.options.on = Domain::kTable;
  result.options.loss = Loss::kCubeRoot;
  result.source = "plain.binary";
  EXPECT_EQ(command_line(result),
            "likeness fit plain.binary --model callisto --tier full --on table --cut 80 --loss cuberoot --starts 7");
}

TEST(Report, TakesAResultWithNothingButAFit) {
  Result result;
  result.material = "bare";
  const std::string page = report_html(result, SyntheticMaterial(example_model(), 0));  // no sample is valid
  EXPECT_EQ(first_tag_error(page), "");
  for (const char* bad : {">nan", " nan", "\"nan", "-nan"}) EXPECT_EQ(page.find(bad), std::string::npos) << bad;
}

TEST(Overview, GroupsByPatternAndSortsByError) {
  const std::string page = overview_html(example_rows(), {{"bad<.binary", "bad<.binary: 3 bytes & no more"}});
  EXPECT_EQ(first_tag_error(page), "");
  EXPECT_EQ(first_outside_reference(page), "");
  const std::size_t flat = page.find("<h2>flat"), bright = page.find("<h2>Fresnel brighter");
  ASSERT_NE(flat, std::string::npos);
  ASSERT_NE(bright, std::string::npos);
  EXPECT_LT(flat, bright);  // the larger group first
  EXPECT_LT(page.find("<b>near</b>"), page.find("<b>middle</b>"));
  EXPECT_LT(page.find("<b>middle</b>"), page.find("<b>far</b>"));
  EXPECT_NE(page.find("Slice error: mean 2.50 %, median 2.50 %, worst 4.00 %"), std::string::npos);
  EXPECT_NE(page.find("bad&lt;.binary: 3 bytes &amp; no more"), std::string::npos);
  EXPECT_NE(page.find("href=\"a%20%22b%22/far.html\""), std::string::npos);
}

TEST(Overview, IsAPageEvenWithoutAnyMaterial) {
  const std::string page = overview_html({}, {{"bad.binary", "empty"}});
  EXPECT_EQ(first_tag_error(page), "");
  EXPECT_EQ(page.find("nan"), std::string::npos);
}

TEST(Browser, ShowsBothPagesWithoutScrollingSidewaysAtDesktopAndPhoneWidth) {
  if (!browser_is_there()) GTEST_SKIP() << "no chromium was found when this was configured";
  const std::string report = report_html(example_result(), SyntheticMaterial(example_model(), 88));
  const std::string overview = overview_html(example_rows(), {{"bad.binary", std::string(300, 'x')}});
  for (const std::string& page : {report, overview})
    for (const int width : {1280, 390}) {
      const BrowserAnswer answer = ask_browser(page, width);
      ASSERT_TRUE(answer.loaded) << answer.dom.substr(0, 500);
      EXPECT_EQ(answer.inner_width, width);
      EXPECT_LE(answer.scroll_width, width);
      EXPECT_EQ(answer.broken_images, 0);
      EXPECT_GT(answer.images, 0);
    }
}

TEST(Browser, SortsTheCardsOfTheOverview) {
  if (!browser_is_there()) GTEST_SKIP() << "no chromium was found when this was configured";
  const BrowserAnswer answer = ask_browser(overview_html(example_rows()), 390);
  ASSERT_TRUE(answer.loaded);
  EXPECT_EQ(answer.first_card, "near");
  EXPECT_EQ(answer.first_card_by_largest_error, "far");
}

TEST(Browser, PaintsTheReportAtDesktopAndPhoneWidth) {
  if (!browser_is_there()) GTEST_SKIP() << "no chromium was found when this was configured";
  const std::string page = report_html(example_result(), SyntheticMaterial(example_model(), 88));
  for (const int width : {1280, 390}) {
    const std::size_t bytes = screenshot_bytes(page, width);
    EXPECT_GT(bytes, 40000u) << width;  // an empty page takes 5 kB, this one 150 kB and more
  }
}

}  // namespace
}  // namespace likeness::fit
