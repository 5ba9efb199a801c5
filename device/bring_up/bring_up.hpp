/// \file The bring-up of a device that nobody on the project has: the steps with a person, and the
/// record that is sent back, without names. Source: docs/devices/bring-up.md.
#pragma once

#include "device/acceptance/acceptance.hpp"
#include "device/unverified_fact.hpp"

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace touchtrial::device {

/// The steps, in their order.
enum class BringUpStep { rest, ways, push, steps, range, weight, wall, program, cable, questions };
inline constexpr std::size_t kBringUpSteps = 10;
[[nodiscard]] std::string_view name_of(BringUpStep step) noexcept;

enum class StepOutcome {
  not_reached,
  interrupted,  ///< a person, a signal or a fault ended it
  left_out,     ///< all or a part of it
  failed,       ///< without a result
  done,
};

/// Where a person feels a push.
enum class FeltSide { right, left, up, down, towards, away, nothing };

/// \name Forces, N
///@{
/// Of a push before the signs are confirmed, and of a second one where nobody felt the first.
/// Sources differ by a factor of 1.8 in a Falcon's force, so that even 0.5 N is below 1 N.
inline constexpr double kFirstPushN = 0.3;
inline constexpr double kSecondPushN = 0.5;
/// The limit of the safety chain, of everything that follows the confirmation.
inline constexpr double kConfirmedN = 2.5;
///@}

/// How the handle was carried by hand along an axis.
struct CarriedWay {
  DeviceAxis axis = DeviceAxis::y;
  Vec3 moved_mm;                     ///< by the readings
  std::optional<double> ruler_mm{};  ///< by a ruler, > 0
  /// Whether the readings followed the axis, and no other more.
  [[nodiscard]] bool is_right() const noexcept;
};

/// A small push, and what the person felt.
struct FeltPush {
  DeviceAxis axis = DeviceAxis::y;
  double force_n = 0.0;  ///< along the axis, signed, of at most kSecondPushN
  FeltSide felt = FeltSide::nothing;
  Vec3 moved_mm;  ///< by the readings, while the force was on
  [[nodiscard]] FeltSide expected() const noexcept;
  /// Whether the person felt another side, or the readings ran against the force.
  [[nodiscard]] bool is_wrong() const noexcept;
};

/// The servo's loop and the device's readings at rest.
struct LoopFigures {
  double rate_hz = 0.0;
  double readings_hz = 0.0;     ///< new readings of the device
  double longest_gap_ms = 0.0;  ///< without a new one
  double p50_us = 0.0;          ///< lateness of ticks
  double p99_us = 0.0;
  double worst_us = 0.0;
  std::int64_t overruns = 0;
};

/// The handle without and with a known weight, on axis y.
struct HungWeight {
  double load_n = 0.0;  ///< that the empty handle needs
  Measured friction_n;  ///< in commanded newtons
  std::optional<WeighResult> weight{};
  /// True newtons for a commanded one.
  [[nodiscard]] std::optional<Measured> scale() const;
};

/// A soft floor that somebody pressed on, and the first two seconds of it.
struct PressedWall {
  static constexpr std::size_t kMostTicks = 2000;
  double stiffness_n_per_mm = 0.0;
  bool swung = false;
  double contact_s = 0.0;
  double delivered_share = 0.0;  ///< ServoReport::delivered_share
  /// \name Of one length: ticks of 1 ms, strictly rising; height; force upwards
  ///@{
  std::vector<int> ms{};
  std::vector<int> height_um{};
  std::vector<int> force_mn{};
  ///@}
};

enum class SilentForce { gone_at_once, gone_within_a_second, stayed_longer, stronger };

/// What a person saw of a force when program or cable were gone, and how the run ended.
struct SilenceSeen {
  SilentForce force = SilentForce::gone_at_once;
  std::string ended{};  ///< names of ServoEnd and of the faults
  std::string fault{};
  std::string device_fault{};
};

enum class BringUpEnd { stopped, complete, wrong_sign, fault };

/// \name The file's words
///@{
[[nodiscard]] std::string_view name_of(StepOutcome outcome) noexcept;
[[nodiscard]] std::string_view name_of(FeltSide side) noexcept;
[[nodiscard]] std::string_view name_of(SilentForce force) noexcept;
[[nodiscard]] std::string_view name_of(BringUpEnd end) noexcept;
///@}

/// Everything that the file has. Holds no name of a person, machine or path.
struct BringUp {
  std::string program{};  ///< version and commit
  std::string driver{};
  std::string device_mark{};  ///< four digits that tell devices of one driver apart; may be empty
  std::string model{};
  std::string firmware{};
  std::string library{};
  /// What the library says: forces, stiffness, damping, rate and workspace alone.
  DeviceInfo stated{};
  std::string scheduling{};  ///< "fifo" or "other"
  bool memory_locked = false;
  std::array<StepOutcome, kBringUpSteps> outcomes{};
  BringUpEnd ended = BringUpEnd::stopped;
  std::string why{};  ///< it ended early; a fixed phrase
  std::optional<RestFigures> rest{};
  std::optional<LoopFigures> loop{};
  std::vector<CarriedWay> ways{};
  std::vector<FeltPush> pushes{};
  std::optional<Measured> step_mm{};
  std::optional<Workspace> reached{};
  std::optional<HungWeight> weight{};
  std::optional<PressedWall> wall{};
  std::optional<SilenceSeen> program_silent{};
  std::optional<SilenceSeen> cable_silent{};
  std::map<std::string, std::string> answers{};  ///< by the facts' ids

  [[nodiscard]] StepOutcome& outcome(BringUpStep step) {
    return outcomes.at(static_cast<std::size_t>(step));
  }
  [[nodiscard]] StepOutcome outcome(BringUpStep step) const {
    return outcomes.at(static_cast<std::size_t>(step));
  }
  /// Whether readings and forces are right on all axes, either way.
  [[nodiscard]] bool signs_confirmed() const;
  /// Whether it settles a fact of its driver, one way or the other.
  [[nodiscard]] bool settles(const UnverifiedFact& fact) const;
};

/// \return what a file may say of a device: the serial number's hash, cut to 16 bits, which tells
///   two devices apart and fits thousands of serial numbers; texts in which the number was replaced
[[nodiscard]] BringUp bring_up_of(const DeviceInfo& device);

/// Leads through the steps. No force beyond kSecondPushN acts before the signs are confirmed, and
/// none at all on what follows a wrong one.
/// \param facts  of the driver, whose questions are asked
/// \param record  of bring_up_of; holds all there is, also after an exception
/// \param save  called after each step
/// \throws whatever bench, person and save throw
void bring_up(AcceptanceBench& bench, AcceptancePerson& person,
              const std::vector<UnverifiedFact>& facts, BringUp& record,
              const std::function<void()>& save);

/// \return the content of its file: JSON
[[nodiscard]] std::string bring_up_json(BringUp record);

/// \param source  names the origin in errors
/// \throws StudyError with the JSON pointer if it is no such file
[[nodiscard]] BringUp parse_bring_up(std::string_view text, const std::string& source);
/// \throws FileError if it cannot be read; as parse_bring_up
[[nodiscard]] BringUp read_bring_up(const std::filesystem::path& file);

}  // namespace touchtrial::device
