/// \file Data that Force Dimension's library does not report: a device's workspace, force and
/// maximum weight, by its reported type. Sources: docs/devices/force-dimension.md; nothing was
/// measured. Private to this folder.
#pragma once

#include "core/vec.hpp"

#include <array>
#include <optional>

namespace touchtrial::device::dhd {

/// A value of 0 is unknown.
struct Model {
  const char* name;
  /// Width, height and depth of the ellipsoid inscribed in the maker's cylinder, whose axis points
  /// towards the person.
  Vec3 workspace_mm;
  double force_n;  ///< peak; the maker states it as continuous
  double continuous_force_n;
  /// The maximum for a wall, from CHAI3D, a public haptics library. The manuals of omega and delta
  /// state 14.5 N/mm in closed loop, which no rendered wall reaches.
  double stiffness_n_per_mm;
  /// An upper bound of the weight of arms and end-effector: 1.5 times the maximum in the maker's
  /// library 3.17.5 for this model or the heaviest model of its family.
  double max_weight_n;
  /// Whether force can be switched off. If not, zero force must be exact, so the library must not
  /// add a weight.
  bool has_switch = true;
};

inline constexpr Model kOmega3 = {"omega.3", {160, 160, 110}, 12, 12, 5, 6.2};
inline constexpr Model kOmega6 = {"omega.6", {160, 160, 110}, 12, 12, 5, 11};
inline constexpr Model kOmega7 = {"omega.7", {160, 160, 110}, 12, 12, 5, 11};
inline constexpr Model kDelta3 = {"delta.3", {400, 400, 260}, 20, 20, 5, 9};
inline constexpr Model kDelta6 = {"delta.6", {400, 400, 260}, 20, 20, 5, 9};
inline constexpr Model kSigma3 = {"sigma.3", {}, 0, 0, 0, 22.5};
inline constexpr Model kSigma6 = {"sigma.6+", {180, 180, 180}, 12, 0, 4, 22.5};
inline constexpr Model kSigma7 = {"sigma.7", {190, 190, 130}, 20, 20, 4, 22.5};
inline constexpr Model kLambda3 = {"lambda.3", {}, 0, 0, 0, 27};
inline constexpr Model kLambda6 = {"lambda.6", {}, 0, 0, 0, 27};
inline constexpr Model kLambda7 = {"lambda.7", {240, 240, 170}, 20, 20, 8, 27};
/// Made by Novint. Its workspace and force equal the driver falcon's.
inline constexpr Model kFalcon = {"Falcon", {80, 80, 80}, 6.5, 2.1, 0, 0, false};

struct ModelOfType {
  int type;  ///< dhdGetSystemType
  const Model* model;
};

/// The types in the maker's header, then types that only CHAI3D assigns to these models.
inline constexpr auto kModelsOfTypes = std::to_array<ModelOfType>({
    {33, &kOmega3},   {34, &kOmega6},   {36, &kOmega6},   {35, &kOmega7},   {37, &kOmega7},
    {63, &kDelta3},   {64, &kDelta6},   {206, &kSigma3},  {106, &kSigma6},  {107, &kSigma6},
    {104, &kSigma7},  {105, &kSigma7},  {203, &kLambda3}, {131, &kLambda6}, {132, &kLambda6},
    {108, &kLambda7}, {109, &kLambda7}, {60, &kFalcon},

    {110, &kOmega3},  {111, &kDelta3},  {133, &kSigma3},  {102, &kSigma7},  {103, &kSigma7},
    {209, &kSigma7},  {112, &kLambda7}, {113, &kLambda7}, {114, &kLambda7}, {117, &kLambda7},
    {118, &kLambda7}, {119, &kLambda7}, {120, &kLambda7}, {121, &kLambda7}, {122, &kLambda7},
    {123, &kLambda7}, {124, &kLambda7}, {125, &kLambda7}, {126, &kLambda7}, {127, &kLambda7},
    {128, &kLambda7}, {129, &kLambda7}, {130, &kLambda7}, {210, &kLambda7}, {211, &kLambda7},
});

/// \return the model; nothing for other types, for instance controllers and custom devices
[[nodiscard]] constexpr std::optional<Model> model_of(int type) noexcept {
  for (const ModelOfType& entry : kModelsOfTypes) {
    if (entry.type == type) return *entry.model;
  }
  return std::nullopt;
}

}  // namespace touchtrial::device::dhd
