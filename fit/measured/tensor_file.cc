#include "fit/measured/tensor_file.h"

#include "fit/measured/little_endian.h"
#include "fit/measured/refuse.h"
#include "fit/measured/rgl.h"

namespace likeness::measured {
namespace {

constexpr std::uint32_t kMostFields = 64;
constexpr std::uint16_t kMostDimensions = 8, kLongestName = 256;
constexpr std::uint8_t kUint8 = 1, kFloat32 = 10;

// Bytes an element of each type of the format: none, (u)int8..64, float16, 32, 64.
constexpr std::uint64_t kSizes[]{0, 1, 1, 2, 2, 4, 4, 8, 8, 2, 4, 8};

}  // namespace

std::vector<Tensor> tensors_in(std::string_view bytes, const std::string& name) {
  if (!bytes.starts_with(kTensorMagic)) refuse(name, "no \"tensor_file\" at its start", "an RGL .bsdf file");
  std::size_t at = kTensorMagic.size();
  const auto need = [&](std::size_t count) {
    if (bytes.size() - at < count)
      refuse(name, std::to_string(bytes.size()) + " bytes", "a whole list of fields: the file is cut short");
  };
  const auto take = [&]<class T>(T) {
    need(sizeof(T));
    const T value = number_at<T>(bytes, at);
    at += sizeof(T);
    return value;
  };
  const auto major = take(std::uint8_t{}), minor = take(std::uint8_t{});
  if (major != 1) refuse(name, "tensor file version " + std::to_string(major) + "." + std::to_string(minor), "1.0");
  const auto fields = take(std::uint32_t{});
  if (fields > kMostFields) refuse(name, std::to_string(fields) + " fields", "at most " + std::to_string(kMostFields));

  std::vector<Tensor> tensors;
  for (std::uint32_t i = 0; i < fields; ++i) {
    Tensor tensor;
    const auto length = take(std::uint16_t{});
    if (length > kLongestName)
      refuse(name, "a field name of " + std::to_string(length) + " letters", "at most " + std::to_string(kLongestName));
    need(length);
    tensor.name = bytes.substr(at, length);
    at += length;
    const auto dimensions = take(std::uint16_t{});
    const auto type = take(std::uint8_t{});
    const auto offset = take(std::uint64_t{});
    if (dimensions > kMostDimensions || type >= std::size(kSizes) || type == 0)
      refuse(name,
             "field " + in_quotes(tensor.name) + " of type " + std::to_string(type) + " with " +
                 std::to_string(dimensions) + " dimensions",
             "a known type and at most 8 dimensions");
    std::uint64_t size = kSizes[type];
    bool fits = offset <= bytes.size();
    for (int d = 0; d < dimensions; ++d) {
      const auto extent = take(std::uint64_t{});
      tensor.shape.push_back(extent);
      fits = fits && (extent == 0 || size <= bytes.size() / extent);
      size = fits ? size * extent : 0;
    }
    if (!fits || size > bytes.size() - offset)
      refuse(name,
             "field " + in_quotes(tensor.name) + " reaches beyond the " + std::to_string(bytes.size()) +
                 " bytes of the file",
             "all data within it: the file is cut short or damaged");
    if (type != kUint8 && type != kFloat32) continue;
    tensor.real = type == kFloat32;
    tensor.data = bytes.substr(offset, size);
    tensors.push_back(std::move(tensor));
  }
  return tensors;
}

}  // namespace likeness::measured
