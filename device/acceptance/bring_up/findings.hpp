/// \file The answers that a bring-up records, and the signs of axes derived from them. Private to
///   this folder.
#pragma once

#include "device/acceptance/bring_up/bring_up.hpp"

#include <array>
#include <string>
#include <string_view>

namespace touchtrial::device {

/// The direction in which a person feels a push: +x, -x, +y, -y, +z, -z, or none.
inline constexpr std::array<std::string_view, 7> kPushDirections = {
    "right", "left", "up", "down", "towards you", "away", "nothing"};
/// How the force ended after the program was suspended or the cable was pulled.
inline constexpr std::array<std::string_view, 4> kForceEndings = {
    "gone at once", "gone within a second", "stayed longer", "became stronger"};

/// \return the sign and the axis, for instance "+x"
[[nodiscard]] std::string signed_name(int sign, DeviceAxis axis);

/// \return whether the readings of a motion followed its axis more than the others
[[nodiscard]] bool followed_axis(const BringUp& record, DeviceAxis axis);

enum class PushSign {
  not_felt,
  correct,
  wrong,  ///< felt in another direction, or the readings moved against the force
};
[[nodiscard]] PushSign sign_of_push(const BringUp& record, DeviceAxis axis, int sign);

/// Adds both ends of each axis.
/// \param name  of the findings, without the axis
void add_extent(BringUp& record, const std::string& name, const Workspace& extent);

}  // namespace touchtrial::device
