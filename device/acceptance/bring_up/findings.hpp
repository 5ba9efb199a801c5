/// \file The words in a bring-up's findings, and their evaluation for signs. Private to this
///   folder.
#pragma once

#include "device/acceptance/bring_up/bring_up.hpp"

#include <array>
#include <string>
#include <string_view>

namespace touchtrial::device {

/// The side on which a person feels a push: +x, -x, +y, -y, +z, -z, or none.
inline constexpr std::array<std::string_view, 7> kSides = {"right",       "left", "up",     "down",
                                                           "towards you", "away", "nothing"};
/// The behaviour of a force without program or cable.
inline constexpr std::array<std::string_view, 4> kSilences = {
    "gone at once", "gone within a second", "stayed longer", "became stronger"};

/// \return "+x"
[[nodiscard]] std::string signed_name(int sign, DeviceAxis axis);

/// Whether the readings of a motion followed its axis more than any other.
[[nodiscard]] bool followed_axis(const BringUp& record, DeviceAxis axis);

enum class PushSign {
  not_felt,
  right,
  wrong,  ///< felt on another side, or the readings ran against the force
};
[[nodiscard]] PushSign sign_of_push(const BringUp& record, DeviceAxis axis, int sign);

/// Notes both ends of each axis.
/// \param name  of the findings, before the axis
void note_extent(BringUp& record, const std::string& name, const Workspace& extent);

}  // namespace touchtrial::device
