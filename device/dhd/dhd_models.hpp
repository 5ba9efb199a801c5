/// \file What Force Dimension's library does not tell of a device: its size and strength, by the
/// type that it does tell. Private to this folder.
#pragma once

#include "core/vec.hpp"

#include <array>
#include <optional>

namespace touchtrial::device::dhd {

/// Where numbers of a model come from. Nothing was measured.
enum class ModelSource {
  manual,        ///< the maker's user manual
  open_library,  ///< a public haptics library (CHAI3D) beside its driver for these devices
};

struct Model {
  int type;  ///< dhdGetSystemType
  const char* name;
  /// Width, height and depth of the ellipsoid in the cylinder that the maker states: its axis
  /// points towards the person.
  Vec3 workspace_mm;
  double force_n;  ///< peak, which the maker states as continuous; 0: not known
  double continuous_force_n;
  double stiffness_n_per_mm;  ///< of a wall
  ModelSource size_source;
  ModelSource force_source;
};

/// Where sources differ, the smaller number stands. Stiffnesses are all the open library's: the
/// manuals of omega and delta state 14.5 N/mm in closed loop, which no wall in a servo reaches.
inline constexpr std::array<Model, 11> kModels = {{
    // Manual of the omega.x, 1.7: a cylinder of 160 mm, 110 mm long; 12 N continuous.
    {33, "omega.3", {160, 160, 110}, 12, 12, 5, ModelSource::manual, ModelSource::manual},
    {34, "omega.6", {160, 160, 110}, 12, 12, 5, ModelSource::manual, ModelSource::manual},
    {36, "omega.6", {160, 160, 110}, 12, 12, 5, ModelSource::manual, ModelSource::manual},
    {35, "omega.7", {160, 160, 110}, 12, 12, 5, ModelSource::manual, ModelSource::manual},
    {37, "omega.7", {160, 160, 110}, 12, 12, 5, ModelSource::manual, ModelSource::manual},
    // Manual of the delta.x: 400 mm, 260 mm long; 20 N continuous.
    {63, "delta.3", {400, 400, 260}, 20, 20, 5, ModelSource::manual, ModelSource::manual},
    {64, "delta.6", {400, 400, 260}, 20, 20, 5, ModelSource::manual, ModelSource::manual},
    // Manual of the sigma.7: 190 mm, 130 mm long; 20 N, of which the open library allows 12.
    {104, "sigma.7", {190, 190, 130}, 12, 12, 4, ModelSource::manual, ModelSource::open_library},
    {105, "sigma.7", {190, 190, 130}, 12, 12, 4, ModelSource::manual, ModelSource::open_library},
    // The open library alone: within 90 mm; 12 N. Nothing says for how long.
    {106,
     "sigma.6+",
     {180, 180, 180},
     12,
     0,
     4,
     ModelSource::open_library,
     ModelSource::open_library},
    {107,
     "sigma.6+",
     {180, 180, 180},
     12,
     0,
     4,
     ModelSource::open_library,
     ModelSource::open_library},
}};

/// \return nothing for a type that the table does not have, for instance lambda, sigma.3, the
///   stand-alone controllers and devices of one's own
[[nodiscard]] constexpr std::optional<Model> model_of(int type) noexcept {
  for (const Model& model : kModels) {
    if (model.type == type) return model;
  }
  return std::nullopt;
}

}  // namespace touchtrial::device::dhd
