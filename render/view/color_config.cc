// The only file that knows OpenColorIO.
#include "render/view/color_config.h"

#include <OpenColorIO/OpenColorIO.h>

#include <algorithm>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "render/files/files.h"

namespace likeness::view {
namespace {

namespace ocio = OCIO_NAMESPACE;
using files::in_quotes;
using files::InputError;

std::string one_line(const std::string& text) {
  std::string out = text.substr(0, 300);
  for (char& c : out)
    if (static_cast<unsigned char>(c) < 0x20) c = ' ';
  return out;
}

std::string list_of(const std::vector<std::string>& names) {
  std::string out;
  for (const std::string& n : names) out += (out.empty() ? "" : ", ") + in_quotes(n);
  return out.empty() ? "none" : out;
}

[[noreturn]] void unknown(const std::string& file, const std::string& what, const std::string& name,
                          const std::vector<std::string>& names) {
  const std::vector<std::string_view> views(names.begin(), names.end());
  const std::string near = files::nearest_name(name, views.data(), views.size());
  throw InputError(file + ": has no " + what + " " + in_quotes(name) +
                   (near.empty() ? "; it has " : "; did you mean " + near + "? It has ") + list_of(names));
}

PixelTransform pixels_of(const ocio::ConstProcessorRcPtr& processor) {
  const ocio::ConstCPUProcessorRcPtr cpu = processor->getDefaultCPUProcessor();
  return [cpu](float* rgb, long count) {
    ocio::PackedImageDesc pixels(rgb, count, 1, 3);
    cpu->apply(pixels);
  };
}

ocio::BuiltinTransformRcPtr built_in(const char* style) {
  ocio::BuiltinTransformRcPtr out = ocio::BuiltinTransform::Create();
  out->setStyle(style);
  return out;
}

// Linear Rec. 709 (D65) to ACES2065-1 (Bradford adapted): through ACEScg, whose matrices are built in.
ocio::GroupTransformRcPtr aces_of_rec709() {
  ocio::BuiltinTransformRcPtr to_ap1 = built_in("UTILITY - ACES-AP1_to_LINEAR-REC709_BFD");
  to_ap1->setDirection(ocio::TRANSFORM_DIR_INVERSE);
  ocio::GroupTransformRcPtr out = ocio::GroupTransform::Create();
  out->appendTransform(to_ap1);
  out->appendTransform(built_in("ACEScg_to_ACES2065-1"));
  return out;
}

// Through the config's own name of linear Rec. 709, where it has one.
ocio::TransformRcPtr display_transform(const ocio::ConstConfigRcPtr& config, const std::string& display,
                                       const std::string& view) {
  ocio::DisplayViewTransformRcPtr out = ocio::DisplayViewTransform::Create();
  out->setDisplay(display.c_str());
  out->setView(view.c_str());
  for (const char* name : {"lin_rec709", "lin_rec709_srgb", "lin_srgb", "Linear Rec.709 (sRGB)",
                           "Utility - Linear - Rec.709", "Utility - Linear - sRGB", "Linear Rec.709", "Linear"})
    if (const ocio::ConstColorSpaceRcPtr space = config->getColorSpace(name); space && !space->isData()) {
      out->setSrc(space->getName());
      return out;
    }
  if (!config->hasRole("aces_interchange")) {
    out->setSrc(ocio::ROLE_SCENE_LINEAR);
    return out;
  }
  out->setSrc("aces_interchange");
  ocio::GroupTransformRcPtr both = aces_of_rec709();
  both->appendTransform(out);
  return both;
}

}  // namespace

namespace {

// The file that is named, or else that $OCIO names; empty: neither.
std::string config_file(const std::string& named) {
  const char* const environment = std::getenv("OCIO");
  return !named.empty() ? named : environment != nullptr ? environment : "";
}

template <class Use>
auto with_config(const std::string& file, Use use) {
  // OpenColorIO reads what it is given whatever it is; a folder or a file of gigabytes is refused here.
  constexpr std::size_t kMostBytes = std::size_t{64} << 20;
  files::read_whole(file, kMostBytes);
  ocio::SetLoggingLevel(ocio::LOGGING_LEVEL_NONE);  // else it prints what it finds odd in a config that it can use
  try {
    const ocio::ConstConfigRcPtr config = ocio::Config::CreateFromFile(file.c_str());
    config->validate();
    return use(config);
  } catch (const ocio::Exception& e) {
    throw InputError(file + ": OpenColorIO cannot use it (" + one_line(e.what()) + ")");
  }
}

// What comes first is the default.
void put_first(std::vector<std::string>& names, const std::string& first) {
  const auto at = std::find(names.begin(), names.end(), first);
  if (at != names.end()) std::rotate(names.begin(), at, at + 1);
}

std::vector<std::string> displays_of(const ocio::ConstConfigRcPtr& config) {
  std::vector<std::string> out;
  for (int i = 0; i < config->getNumDisplays(); ++i) out.emplace_back(config->getDisplay(i));
  put_first(out, config->getDefaultDisplay());
  return out;
}

std::vector<std::string> views_on(const ocio::ConstConfigRcPtr& config, const std::string& display) {
  std::vector<std::string> out;
  for (int i = 0; i < config->getNumViews(display.c_str()); ++i) out.emplace_back(config->getView(display.c_str(), i));
  put_first(out, config->getDefaultView(display.c_str()));
  return out;
}

void check_listed(const std::string& file, const std::string& what, const std::string& name,
                  const std::vector<std::string>& names) {
  if (std::find(names.begin(), names.end(), name) == names.end()) unknown(file, what, name, names);
}

}  // namespace

std::optional<ConfigViews> views_of_config(const std::string& named) {
  const std::string file = config_file(named);
  if (file.empty()) return std::nullopt;
  return with_config(file, [&](const ocio::ConstConfigRcPtr& config) {
    ConfigViews out{file, named.empty(), {}};
    for (const std::string& display : displays_of(config)) out.displays.push_back({display, views_on(config, display)});
    return std::optional(out);
  });
}

PixelTransform view_of_config(const std::string& named, const std::string& display, const std::string& view) {
  const std::string file = config_file(named);
  if (file.empty())
    throw InputError("view " + in_quotes(view) +
                     " is none of srgb, gt, khronos, agx and aces, and no OpenColorIO config is named (in the scene's "
                     "view, or by $OCIO)");
  return with_config(file, [&](const ocio::ConstConfigRcPtr& config) {
    const std::vector<std::string> displays = displays_of(config);
    const std::string on = display.empty() ? config->getDefaultDisplay() : display;
    check_listed(file, "display", on, displays);
    check_listed(file, "view", view, views_on(config, on));
    return pixels_of(config->getProcessor(display_transform(config, on, view)));
  });
}

namespace {

// Throws std::runtime_error where OpenColorIO was built without ACES.
ocio::ConstProcessorRcPtr aces_processor() {
  ocio::GroupTransformRcPtr steps = aces_of_rec709();
  steps->appendTransform(built_in("ACES-OUTPUT - ACES2065-1_to_CIE-XYZ-D65 - SDR-VIDEO_1.0"));
  steps->appendTransform(built_in("DISPLAY - CIE-XYZ-D65_to_sRGB"));
  const ocio::ConfigRcPtr config = ocio::Config::CreateRaw()->createEditableCopy();
  config->setVersion(2, 1);
  return config->getProcessor(steps);
}

[[noreturn]] void no_aces(const ocio::Exception& e) {
  throw std::runtime_error("view aces: this OpenColorIO has no ACES transforms (" + one_line(e.what()) + ")");
}

}  // namespace

PixelTransform aces_view() {
  try {
    return pixels_of(aces_processor());
  } catch (const ocio::Exception& e) {
    no_aces(e);
  }
}

std::string aces_shader_text() {
  try {
    ocio::GpuShaderDescRcPtr shader = ocio::GpuShaderDesc::CreateShaderDesc();
    shader->setLanguage(ocio::GPU_LANGUAGE_GLSL_ES_3_0);
    shader->setFunctionName("aces_view");
    aces_processor()->getDefaultGPUProcessor()->extractGpuShaderInfo(shader);
    if (shader->getNumTextures() + shader->getNum3DTextures() > 0)
      throw std::runtime_error("view aces: this OpenColorIO needs textures for its ACES transforms");
    return shader->getShaderText();
  } catch (const ocio::Exception& e) {
    no_aces(e);
  }
}

}  // namespace likeness::view
