#pragma once

#include <filesystem>
#include <string>

#include "render/scene/format.h"
#include "render/scene/loading.h"

namespace likeness::scene {

// Each section of a scene file to the value that it describes. `folder` is where the files are that it names. All throw
// files::InputError, one line.
Camera camera_of(const Fields& fields);
Light light_of(const Fields& fields, const std::filesystem::path& folder, Loading& loading);
Material material_of(const Fields& fields, const std::string& name, const std::filesystem::path& folder,
                     Loading& loading);
Environment environment_of(const Fields& fields, const std::filesystem::path& folder, Loading& loading);
View view_of(const Fields& fields, const std::filesystem::path& folder);
// World from object, of an instance.
glm::dmat4 place_of(const Fields& fields);

// Camera to world: looks from `position` along `forward` (unit). Where `up` is along the view, -z is up.
glm::dmat4 look_along(const glm::dvec3& position, const glm::dvec3& forward, const glm::dvec3& up);

}  // namespace likeness::scene
