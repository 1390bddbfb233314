#include "render/image/exr_exposure.h"

#include <ImfFloatAttribute.h>
#include <ImfHeader.h>
#include <ImfMultiPartInputFile.h>

#include <exception>

#include "render/files/files.h"
#include "render/image/exr_header.h"
#include "render/image/exr_stream.h"
#include "render/image/read_exr.h"

namespace likeness::image {

ExrExposure exposure_of_exr(std::string_view bytes, const std::string& name) {
  if (!is_exr(bytes)) return {};
  check_exr_header(bytes, name);
  try {
    MemoryInput stream(bytes);
    Imf::MultiPartInputFile file(stream, 0, false);
    const Imf::Header& header = file.header(0);
    const auto value = [&](const char* key) -> std::optional<double> {
      const auto* attribute = header.findTypedAttribute<Imf::FloatAttribute>(key);
      return attribute == nullptr ? std::nullopt : std::optional(static_cast<double>(attribute->value()));
    };
    return {value("expTime"), value("isoSpeed"), value("aperture")};
  } catch (const std::exception& error) {
    throw files::InputError(name + ": " + error.what());
  }
}

}  // namespace likeness::image
