/// \file Words of a bring-up's findings, and what they say of signs. Private to this folder.
#pragma once

#include "device/acceptance/bring_up/bring_up.hpp"

#include <array>
#include <string>
#include <string_view>

namespace touchtrial::device {

/// Where a person feels a push: along +x, -x, +y, -y, +z, -z, or nowhere.
inline constexpr std::array<std::string_view, 7> kSides = {"right",       "left", "up",     "down",
                                                           "towards you", "away", "nothing"};
/// What a force did while program or cable were gone.
inline constexpr std::array<std::string_view, 4> kSilences = {
    "gone at once", "gone within a second", "stayed longer", "became stronger"};

/// \return "+x"
[[nodiscard]] std::string signed_name(int sign, DeviceAxis axis);

/// Whether the readings of a way followed its axis, and no other more.
[[nodiscard]] bool was_carried_right(const BringUp& record, DeviceAxis axis);

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
