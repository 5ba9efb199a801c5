/// \file The bring-up: first tests of a device that the project does not have, guided by the
///   program, with an anonymous record to send in. Source: docs/devices/bring-up.md.
#pragma once

#include "device/acceptance/acceptance.hpp"
#include "device/device_settings.hpp"
#include "device/drivers/unverified_fact.hpp"

#include <array>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace touchtrial::device {

/// The steps, in order.
enum class BringUpStep {
  open,
  rest,       ///< noise of the released handle
  ways,       ///< signs of positions: the handle moves along a ruler
  push,       ///< signs of forces: the person reports the direction of pushes
  steps,      ///< resolution of the encoders
  range,      ///< ends of the workspace
  weight,     ///< scale of the force
  wall,       ///< stability in contact
  program,    ///< the program is suspended
  cable,      ///< the cable is pulled
  questions,  ///< the driver's unverified facts
};
inline constexpr std::size_t kBringUpSteps = 11;
[[nodiscard]] std::string_view name_of(BringUpStep step) noexcept;

enum class StepOutcome {
  not_reached,
  interrupted,  ///< a person, a signal or a fault ended it
  left_out,     ///< the person skipped at least part of it
  failed,       ///< no result
  done,
};
[[nodiscard]] std::string_view name_of(StepOutcome outcome) noexcept;

enum class BringUpEnd { stopped, complete, wrong_sign, fault };
[[nodiscard]] std::string_view name_of(BringUpEnd end) noexcept;

/// \name Forces, N
/// @{ Pushes before the signs are confirmed; the second one follows if the first is not felt.
/// Sources of a Falcon's force differ by a factor of 1.8, so even 0.5 N may be 0.9 N.
inline constexpr double kFirstPushN = 0.3;
inline constexpr double kSecondPushN = 0.5;
/// The safety chain's limit once the signs are confirmed.
inline constexpr double kConfirmedN = 2.5;
///@}

/// One result of a step: numbers of one unit, or a word.
struct Finding {
  std::string name;  ///< unique, with the unit: "noise_mm"; for an axis, with suffix " x" or " +x"
  std::vector<double> numbers{};
  std::string word{};
};

/// The record. It contains no names of people or machines, and no paths.
struct BringUp {
  std::string program{};  ///< version and commit
  std::string driver{};
  std::string device_mark{};  ///< four digits that distinguish devices of one driver; may be empty
  std::string model{};
  std::string firmware{};
  std::string library{};
  std::string stand_in{};    ///< from stand_in_of; empty: the device appears to be hardware
  std::string scheduling{};  ///< "fifo" or "other"
  bool memory_locked = false;
  std::array<StepOutcome, kBringUpSteps> outcomes{};
  BringUpEnd ended = BringUpEnd::stopped;
  std::string reason{};  ///< for ending early; a fixed phrase
  std::vector<Finding> findings{};

  [[nodiscard]] StepOutcome& outcome(BringUpStep step) {
    return outcomes.at(static_cast<std::size_t>(step));
  }
  [[nodiscard]] StepOutcome outcome(BringUpStep step) const {
    return outcomes.at(static_cast<std::size_t>(step));
  }
  /// \return the finding; null if there is none
  [[nodiscard]] const Finding* find(std::string_view name) const noexcept;
  /// \return the finding's first number; 0 if there is none
  [[nodiscard]] double number(std::string_view name) const noexcept;
  /// \name Add a finding, or replace the one with this name
  ///@{
  void note(const std::string& name, std::vector<double> numbers);
  void note(const std::string& name, std::string_view word);
  /// @} Whether readings and forces have the right sign on all axes in both directions.
  [[nodiscard]] bool signs_confirmed() const;
};

/// \return evidence that the device is not real hardware, as a phrase; empty: none
[[nodiscard]] std::string stand_in_of(const DeviceInfo& device, const DeviceSettings& settings);

/// \return a record of the device without its serial number. A hash of 16 bits distinguishes two
///   devices but matches thousands of serial numbers; it also replaces the number within texts.
[[nodiscard]] BringUp bring_up_of(const DeviceInfo& device);

/// Guides a person through the steps. No force beyond kSecondPushN acts before the signs are
/// confirmed, and none after a wrong sign.
/// \param facts  the driver's unverified facts, whose questions are asked
/// \param record  from bring_up_of; contains all results so far even after an exception
/// \param save  called after each step
/// \throws what bench, person and save throw
void bring_up(AcceptanceBench& bench, AcceptancePerson& person,
              const std::vector<UnverifiedFact>& facts, BringUp& record,
              const std::function<void()>& save);

/// \return the content of the record's file: JSON
[[nodiscard]] std::string bring_up_json(const BringUp& record);

}  // namespace touchtrial::device
