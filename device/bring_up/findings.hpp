/// \file Names and words of a bring-up's findings, and what they say of signs. Private to this folder.
#pragma once

#include "device/bring_up/bring_up.hpp"

#include <array>
#include <span>
#include <string>
#include <string_view>

namespace touchtrial::device {

/// Where a person feels a push: along +x, -x, +y, -y, +z, -z, or nowhere.
inline constexpr std::array<std::string_view, 7> kSides = {"right",       "left", "up",     "down",
                                                           "towards you", "away", "nothing"};
/// What a force did while program or cable were gone.
inline constexpr std::array<std::string_view, 4> kSilences = {
    "gone at once", "gone within a second", "stayed longer", "became stronger"};

/// What a step may find.
struct FindingKind {
  BringUpStep step = BringUpStep::open;
  std::string_view name;                      ///< without an axis
  std::string_view unit{};                    ///< of its numbers
  Evidence shows = Evidence::none;            ///< which facts it settles
  std::span<const std::string_view> words{};  ///< that it may be; empty: it is numbers
};
/// \param name  of a finding, with or without an axis
/// \return null if no step finds it; answers to a driver's questions are none
[[nodiscard]] const FindingKind* kind_of(std::string_view name) noexcept;

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
