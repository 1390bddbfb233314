#include "realis/texture/light_file.h"

#include <fstream>
#include <sstream>

#include "render/files/files.h"

namespace likeness::realis {
namespace {

constexpr std::string_view kFirstLine = "likeness light samples 1";
constexpr std::size_t kMostHeader = std::size_t{1} << 24;

std::string_view bytes_of(std::span<const float> values) {
  return {reinterpret_cast<const char*>(values.data()), values.size_bytes()};
}

}  // namespace

std::size_t bytes_of_light(std::size_t texels, std::size_t channels, std::size_t candidates) {
  return sizeof(float) * (texels * (1 + channels) + 3 * candidates);
}

void write_light(const std::filesystem::path& file, const std::string& digest, const LightSamples& samples) {
  std::ostringstream text;
  const LightCensus& c = samples.census;
  text << kFirstLine << '\n' << digest << '\n';
  text << c.samples << ' ' << c.clipped << ' ' << c.not_finite << ' ' << c.negative << ' ' << files::number_text(c.sum)
       << '\n';
  for (const auto& [name, hash] : samples.inputs) text << hash << ' ' << name << '\n';
  const std::string header = text.str();
  files::WholeFile out(file);
  out.append(std::to_string(header.size()) + "\n" + header);
  out.append(bytes_of(samples.weights)), out.append(bytes_of(samples.residuals)),
      out.append(bytes_of(samples.candidates));
  out.commit();
}

std::optional<LightFile> LightFile::open(const std::filesystem::path& file, const std::string& digest,
                                         std::size_t texels, std::size_t channels, std::size_t candidates) {
  std::ifstream in(file, std::ios::binary);
  std::string line;
  if (!std::getline(in, line) || line.empty() || line.size() > 8 ||
      line.find_first_not_of("0123456789") != std::string::npos)
    return {};
  const std::size_t length = std::stoul(line);
  if (length > kMostHeader) return {};
  std::string header(length, '\0');
  if (!in.read(header.data(), static_cast<std::streamsize>(length))) return {};
  LightFile out;
  out.file_ = file, out.begin_ = line.size() + 1 + length;
  out.texels_ = texels, out.channels_ = channels, out.candidates_ = candidates;
  std::error_code error;
  if (std::filesystem::file_size(file, error) != out.begin_ + bytes_of_light(texels, channels, candidates) || error)
    return {};
  std::istringstream text(header);
  std::string first, of;
  std::getline(text, first), std::getline(text, of);
  if (first != kFirstLine || of != digest) return {};
  LightCensus& c = out.census_;
  text >> c.samples >> c.clipped >> c.not_finite >> c.negative >> c.sum;
  std::getline(text, line);
  while (std::getline(text, line))
    if (const std::size_t space = line.find(' '); space != std::string::npos)
      out.inputs_.emplace_back(line.substr(space + 1), line.substr(0, space));
  return out;
}

void LightFile::read(std::size_t first, std::span<float> weights, std::span<float> residuals) const {
  const std::size_t count = weights.size();
  read_floats(file_, begin_ + sizeof(float) * first, weights);
  for (std::size_t c = 0; c < channels_; ++c)
    read_floats(file_, begin_ + sizeof(float) * ((1 + c) * texels_ + first), residuals.subspan(c * count, count));
}

std::vector<float> LightFile::candidates() const {
  std::vector<float> out(3 * candidates_);
  read_floats(file_, begin_ + sizeof(float) * (1 + channels_) * texels_, out);
  return out;
}

void read_floats(const std::filesystem::path& file, std::size_t first_byte, std::span<float> out) {
  std::ifstream in(file, std::ios::binary);
  in.seekg(static_cast<std::streamoff>(first_byte));
  if (!in.read(reinterpret_cast<char*>(out.data()), static_cast<std::streamsize>(out.size_bytes())))
    throw files::InputError(file.string() + ": cannot be read any more; begin anew with --out, or remove it");
}

}  // namespace likeness::realis
