#include "render/scene/ies.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <vector>

#include "render/files/files.h"

namespace likeness::scene {
namespace {

constexpr std::size_t kMostAngles = 4096;

// The numbers of the file one after the other; commas separate as blanks do.
class Numbers {
 public:
  Numbers(std::string_view text, std::size_t line, const std::string& source)
      : text_(text), line_(line), source_(source) {}

  double next(const std::string& what) {
    skip_blanks();
    if (text_.empty()) refuse("the file ends where " + what + " should be");
    const char* begin = text_.data() + (text_[0] == '+');
    const char* end = text_.data() + text_.size();
    double value = 0;
    const auto [stop, error] = std::from_chars(begin, end, value);
    if (error != std::errc() || !std::isfinite(value) || (stop != end && !is_blank(*stop))) {
      std::size_t size = 0;
      while (size < text_.size() && !is_blank(text_[size])) ++size;
      refuse(what + " is " + files::in_quotes(text_.substr(0, size)) + "; expected a number");
    }
    text_.remove_prefix(static_cast<std::size_t>(stop - text_.data()));
    return value;
  }

  std::size_t whole(const std::string& what, double low, double high) {
    const double value = next(what);
    if (value != std::floor(value) || !(value >= low && value <= high))
      refuse(what + " = " + files::number_text(value) + "; expected a whole number from " + files::number_text(low) +
             " to " + files::number_text(high));
    return static_cast<std::size_t>(value);
  }

  std::vector<float> angles(std::size_t count, const std::string& what, double low, double high) {
    std::vector<float> out;
    out.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
      const double angle = next("a " + what + " angle");
      if (!(angle >= low && angle <= high))
        refuse("the " + what + " angle " + files::number_text(angle) + " is outside [" + files::number_text(low) +
               ", " + files::number_text(high) + "] degrees");
      if (!out.empty() && !(static_cast<float>(angle) > out.back()))
        refuse("the " + what + " angle " + files::number_text(angle) + " does not come after " +
               files::number_text(static_cast<double>(out.back())) + "; expected ascending angles");
      out.push_back(static_cast<float>(angle));
    }
    return out;
  }

  [[noreturn]] void refuse(const std::string& text) const {
    throw files::InputError(source_ + ":" + std::to_string(line_) + ": " + text);
  }

 private:
  static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == ',' || c == '\x1a'; }
  void skip_blanks() {
    std::size_t size = 0;
    while (size < text_.size() && is_blank(text_[size])) line_ += text_[size++] == '\n';
    text_.remove_prefix(size);
  }

  std::string_view text_;
  std::size_t line_;
  const std::string& source_;
};

bool near(float a, double b) { return std::abs(a - b) < 1e-3; }

// Row h of the candela, appended to `out` as the plane of `angle`.
struct Planes {
  const std::vector<float>& candela;
  std::size_t height;
  Profile& out;

  void append(float angle, std::size_t h) const {
    out.horizontal_deg.push_back(angle);
    const auto from = candela.begin() + static_cast<std::ptrdiff_t>(h * height);
    out.candela.insert(out.candela.end(), from, from + static_cast<std::ptrdiff_t>(height));
  }
};

// Type C to [0, 360]; see profile_of.
void complete_c(const std::vector<float>& angles, const Planes& planes, const Numbers& numbers) {
  const std::size_t n = angles.size();
  const double first = angles.front(), last = angles.back();
  if (near(angles.front(), 0) && near(angles.back(), 360)) {
    for (std::size_t h = 0; h < n; ++h) planes.append(angles[h], h);
  } else if (near(angles.front(), 0) && last > 180.001 && last < 360) {
    // Some files leave out 360, which is 0 again.
    for (std::size_t h = 0; h < n; ++h) planes.append(angles[h], h);
    planes.append(360, 0);
  } else if (near(angles.front(), 0) && near(angles.back(), 180)) {
    for (std::size_t h = 0; h < n; ++h) planes.append(angles[h], h);
    for (std::size_t h = n - 1; h-- > 0;) planes.append(360 - angles[h], h);
  } else if (near(angles.front(), 0) && near(angles.back(), 90)) {
    for (std::size_t h = 0; h < n; ++h) planes.append(angles[h], h);
    for (std::size_t h = n - 1; h-- > 0;) planes.append(180 - angles[h], h);
    for (std::size_t h = 1; h < n; ++h) planes.append(180 + angles[h], h);
    for (std::size_t h = n - 1; h-- > 0;) planes.append(360 - angles[h], h);
  } else if (near(angles.front(), 90) && near(angles.back(), 270)) {
    // From 90 to 270, mirrored at that plane: angle a and 180 - a are equal. The planes from 180 down to 90 are those
    // of 0 to 90, those from 270 down to 180 those of 270 to 360.
    const auto half =
        static_cast<std::size_t>(std::lower_bound(angles.begin(), angles.end(), 180.0f - 1e-3f) - angles.begin());
    if (half == n || !near(angles[half], 180)) numbers.refuse("horizontal angles from 90 to 270 leave out 180");
    for (std::size_t h = half + 1; h-- > 0;) planes.append(180 - angles[h], h);
    for (std::size_t h = 1; h < n; ++h) planes.append(angles[h], h);
    for (std::size_t h = n - 1; h-- > half;) planes.append(540 - angles[h], h);
  } else {
    numbers.refuse("horizontal angles of type C run from " + files::number_text(first) + " to " +
                   files::number_text(last) + "; expected 0 alone, 0 to 90, 0 to 180, 90 to 270 or 0 to 360");
  }
}

void complete_b(const std::vector<float>& angles, const Planes& planes, const Numbers& numbers) {
  const std::size_t n = angles.size();
  if (near(angles.front(), 0) && near(angles.back(), 90))
    for (std::size_t h = n; h-- > 1;) planes.append(-angles[h], h);
  else if (!near(angles.front(), -90) || !near(angles.back(), 90))
    numbers.refuse("horizontal angles of type B run from " + files::number_text(static_cast<double>(angles.front())) +
                   " to " + files::number_text(static_cast<double>(angles.back())) + "; expected 0 to 90 or -90 to 90");
  for (std::size_t h = 0; h < n; ++h) planes.append(angles[h], h);
}

// Vertical angles 0 to 90 of type B, to [-90, 90].
void mirror_vertical(std::vector<float>& angles, std::vector<float>& candela, std::size_t width) {
  const std::size_t height = angles.size(), whole = 2 * height - 1;
  std::vector<float> out(width * whole);
  for (std::size_t h = 0; h < width; ++h)
    for (std::size_t v = 0; v < whole; ++v)
      out[h * whole + v] = candela[h * height + (v < height ? height - 1 - v : v - height + 1)];
  candela = std::move(out);
  std::vector<float> mirrored;
  for (std::size_t v = height; v-- > 1;) mirrored.push_back(-angles[v]);
  angles.insert(angles.begin(), mirrored.begin(), mirrored.end());
}

// Cuts off and returns the first line, without its end; counts it.
std::string_view take_line(std::string_view& text, std::size_t& line) {
  const std::size_t end = text.find('\n');
  std::string_view out = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  if (!out.empty() && out.back() == '\r') out.remove_suffix(1);
  ++line;
  return out;
}

}  // namespace

Profile profile_of(std::string_view text, const std::string& source) {
  // Keywords up to the line that begins TILT=. The file of 1986 has no first line of its own.
  std::size_t line = 0;
  std::string_view tilt;
  while (!text.empty() && tilt.empty()) {
    const std::string_view one = take_line(text, line);
    if (one.starts_with("TILT=")) tilt = one.substr(5);
    else if (one.starts_with("TILT =")) tilt = one.substr(6);
  }
  if (tilt.empty()) throw files::InputError(source + ":1: has no line TILT=; expected a photometric file of IES LM-63");
  while (!tilt.empty() && tilt.front() == ' ') tilt.remove_prefix(1);

  Numbers numbers(text, line + 1, source);
  if (tilt.starts_with("INCLUDE")) {
    numbers.whole("the tilt's lamp position", 1, 3);
    const std::size_t count = numbers.whole("the number of tilt angles", 1, kMostAngles);
    for (std::size_t i = 0; i < 2 * count; ++i) numbers.next("the tilt table");
  }
  numbers.whole("the number of lamps", 1, 1e6);
  numbers.next("the lumens of a lamp");
  const double multiplier = numbers.next("the candela multiplier");
  const std::size_t height = numbers.whole("the number of vertical angles", 1, kMostAngles);
  const std::size_t width = numbers.whole("the number of horizontal angles", 1, kMostAngles);
  const std::size_t type = numbers.whole("the photometric type", 1, 3);
  if (type == 3) numbers.refuse("the photometric type is 3 (A), of headlamps; expected 1 (C) or 2 (B)");
  numbers.whole("the unit of length", 1, 2);
  for (const char* side : {"the width", "the length", "the height"}) numbers.next(side);
  const double ballast = numbers.next("the ballast factor");
  const double photometric = numbers.next("the ballast-lamp factor");
  numbers.next("the input watts");
  const double scale = multiplier * ballast * photometric;
  if (!(scale > 0)) numbers.refuse("multiplier times factors is " + files::number_text(scale) + "; expected above 0");

  Profile out;
  out.name = source;
  out.type = type == 1 ? Profile::Type::kC : Profile::Type::kB;
  const bool is_c = type == 1;
  out.vertical_deg = numbers.angles(height, "vertical", is_c ? 0 : -90, is_c ? 180 : 90);
  const std::vector<float> horizontal = numbers.angles(width, "horizontal", is_c ? 0 : -90, is_c ? 360 : 90);
  std::vector<float> candela(width * height);
  for (float& value : candela) {
    const double number = scale * numbers.next("the candela");
    if (!(number >= 0 && number < 1e12))
      numbers.refuse("a candela of " + files::number_text(number) + "; expected 0 or more");
    value = static_cast<float>(number);
  }
  if (!is_c && near(out.vertical_deg.front(), 0)) mirror_vertical(out.vertical_deg, candela, width);
  const Planes planes{candela, out.vertical_deg.size(), out};
  if (width == 1 && !is_c) numbers.refuse("type B with one horizontal angle; expected 0 to 90 or -90 to 90");
  if (width == 1) planes.append(horizontal[0], 0);
  else if (is_c) complete_c(horizontal, planes, numbers);
  else complete_b(horizontal, planes, numbers);
  if (!(peak(out) > 0)) numbers.refuse("every candela is 0; expected a light");
  return out;
}

float peak(const Profile& profile) {
  return profile.candela.empty() ? 0 : *std::max_element(profile.candela.begin(), profile.candela.end());
}

double solid_angle(const Profile& profile) {
  // Along the vertical angle, candela is linear in each cell: the integral of (a + b t) w(t) dt with w = sin t (type C,
  // t from the nadir) or cos t (type B, t from the equator of its axis) is closed. Along the other it is a trapezoid.
  // In type B the horizontal angle is the one whose circles shrink.
  const double peak_value = peak(profile);
  if (!(peak_value > 0)) return 0;
  constexpr double kRadian = std::numbers::pi / 180;
  const std::size_t height = profile.vertical_deg.size(), width = profile.horizontal_deg.size();
  const bool is_c = profile.type == Profile::Type::kC;
  const auto at = [&](std::size_t h, std::size_t v) {
    return static_cast<double>(profile.candela[h * height + v]) / peak_value;
  };
  // The integral between angles p and q [rad], value from y to z, of value(t) sin t dt or value(t) cos t dt.
  const auto weighted = [](double p, double q, double y, double z, bool with_sine) {
    const double slope = (z - y) / (q - p);
    if (with_sine) return y * std::cos(p) - z * std::cos(q) + slope * (std::sin(q) - std::sin(p));
    return z * std::sin(q) - y * std::sin(p) + slope * (std::cos(q) - std::cos(p));
  };
  const auto& round = is_c ? profile.horizontal_deg : profile.vertical_deg;  // whose circles do not shrink
  const auto& shrinking = is_c ? profile.vertical_deg : profile.horizontal_deg;
  const auto strip = [&](std::size_t r) {
    double sum = 0;
    for (std::size_t s = 0; s + 1 < shrinking.size(); ++s) {
      const double y = is_c ? at(r, s) : at(s, r), z = is_c ? at(r, s + 1) : at(s + 1, r);
      sum += weighted(static_cast<double>(shrinking[s]) * kRadian, static_cast<double>(shrinking[s + 1]) * kRadian, y,
                      z, is_c);
    }
    return sum;
  };
  if (is_c && width == 1) return 2 * std::numbers::pi * strip(0);
  double sum = 0;
  for (std::size_t r = 0; r + 1 < round.size(); ++r)
    sum += 0.5 * static_cast<double>(round[r + 1] - round[r]) * kRadian * (strip(r) + strip(r + 1));
  return sum;
}

}  // namespace likeness::scene
