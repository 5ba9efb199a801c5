/// \file The bring-up of a device that the project does not have: the steps with a person, and the
///   record without names that is sent in. Source: docs/devices/bring-up.md.
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

/// The steps, in their order.
enum class BringUpStep {
  open,
  rest,
  ways,
  push,
  steps,
  range,
  weight,
  wall,
  program,
  cable,
  questions
};
inline constexpr std::size_t kBringUpSteps = 11;
[[nodiscard]] std::string_view name_of(BringUpStep step) noexcept;

enum class StepOutcome {
  not_reached,
  interrupted,  ///< a person, a signal or a fault ended it
  left_out,     ///< all or a part of it
  failed,       ///< without a result
  done,
};
[[nodiscard]] std::string_view name_of(StepOutcome outcome) noexcept;

enum class BringUpEnd { stopped, complete, wrong_sign, fault };
[[nodiscard]] std::string_view name_of(BringUpEnd end) noexcept;

/// \name Forces, N
/// @{ Of the first push before the signs are confirmed, and of a second one if the first was not
/// felt. Sources differ by a factor of 1.8 in a Falcon's force, so that even 0.5 N is below 1 N.
inline constexpr double kFirstPushN = 0.3;
inline constexpr double kSecondPushN = 0.5;
/// The limit of the safety chain after the confirmation.
inline constexpr double kConfirmedN = 2.5;
///@}

/// One result of a step: numbers of one unit, or a word.
struct Finding {
  std::string
      name;  ///< unique, with the unit: "noise_mm"; of an axis, with the suffix " x" or " +x"
  std::vector<double> numbers{};
  std::string word{};
};

/// The content of the file. It contains no names of people, machines or paths.
struct BringUp {
  std::string program{};  ///< version and commit
  std::string driver{};
  std::string device_mark{};  ///< four digits that distinguish devices of one driver; may be empty
  std::string model{};
  std::string firmware{};
  std::string library{};
  std::string stand_in{};    ///< of stand_in_of; empty: it appears to be hardware
  std::string scheduling{};  ///< "fifo" or "other"
  bool memory_locked = false;
  std::array<StepOutcome, kBringUpSteps> outcomes{};
  BringUpEnd ended = BringUpEnd::stopped;
  std::string why{};  ///< it ended early; a fixed phrase
  std::vector<Finding> findings{};

  [[nodiscard]] StepOutcome& outcome(BringUpStep step) {
    return outcomes.at(static_cast<std::size_t>(step));
  }
  [[nodiscard]] StepOutcome outcome(BringUpStep step) const {
    return outcomes.at(static_cast<std::size_t>(step));
  }
  /// \return null if it was not found
  [[nodiscard]] const Finding* find(std::string_view name) const noexcept;
  /// \return its first number; 0 if it was not found
  [[nodiscard]] double number(std::string_view name) const noexcept;
  /// \name Add a finding, or replace one of this name
  ///@{
  void note(const std::string& name, std::vector<double> numbers);
  void note(const std::string& name, std::string_view word);
  /// @} Whether readings and forces have the right sign on all axes in both directions.
  [[nodiscard]] bool signs_confirmed() const;
};

/// \return evidence that this is not real hardware, as a phrase; empty: none
[[nodiscard]] std::string stand_in_of(const DeviceInfo& device, const DeviceSettings& settings);

/// \return a record of the device without its serial number: a hash cut to 16 bits, which
///   distinguishes two devices but fits thousands of serial numbers; the number is replaced in
///   texts
[[nodiscard]] BringUp bring_up_of(const DeviceInfo& device);

/// Guides a person through the steps. No force beyond kSecondPushN acts before the signs are
/// confirmed, and none after a wrong sign.
/// \param facts  the driver's unverified facts, whose questions are asked
/// \param record  from bring_up_of; complete up to now even after an exception
/// \param save  called after each step
/// \throws what bench, person and save throw
void bring_up(AcceptanceBench& bench, AcceptancePerson& person,
              const std::vector<UnverifiedFact>& facts, BringUp& record,
              const std::function<void()>& save);

/// \return the content of its file: JSON
[[nodiscard]] std::string bring_up_json(const BringUp& record);

}  // namespace touchtrial::device
