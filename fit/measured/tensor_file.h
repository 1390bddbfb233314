#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace likeness::measured {

// One array of an RGL tensor file.
struct Tensor {
  std::string name;
  std::vector<std::uint64_t> shape;
  std::string_view data;  // of the file's bytes: 4 bytes an element if `real`, else 1
  bool real = false;      // float32; else uint8

  std::size_t size() const { return data.size() / (real ? 4 : 1); }
};

// The float32 and uint8 arrays of a tensor file (others are passed over), each known to lie within the file:
// "tensor_file\0", two bytes of version (1, 0), uint32 count; for each uint16 length and name, uint16 number of
// dimensions, uint8 type, uint64 offset, uint64 shape. `bytes` outlives the result. Throws files::InputError.
std::vector<Tensor> tensors_in(std::string_view bytes, const std::string& name);

}  // namespace likeness::measured
