/// \file A stand-in for Force Dimension's library, with an arm, its weight and a hand behind it:
/// what a person at the device feels can be measured. Where each behaviour comes from stands in
/// maker_dhd.cpp. It shares neither declarations nor assumptions with the driver.
///
/// The frame is the maker's: x towards the person, y to the right, z up; the origin is the middle
/// of the workspace. Vectors named `_m` are in metres.
#pragma once

#include "device/fakes/fake_parts.hpp"

#include <atomic>
#include <string>
#include <vector>

namespace touchtrial::fakes {

/// An arm as the maker's library models it.
struct MakerArm {
  int type = 33;                   ///< as dhdGetSystemType gives it
  const char* name = "omega.3";    ///< as dhdGetSystemName gives it
  double links_n = 1.04;           ///< weight of the arm without its end-effector, at the tip
  double effector_kg = 0.22;       ///< mass of the end-effector
  Vec3 inertia_kg{0.3, 0.2, 0.2};  ///< what a hand at the tip has to accelerate
  double motors_n = 12.0;          ///< the largest force at the tip

  [[nodiscard]] double weight_n() const noexcept { return links_n + 9.81 * effector_kg; }
};

inline constexpr MakerArm kOmega3{};
inline constexpr MakerArm kDelta3{63, "delta.3", 1.43, 0.279, {0.145, 0.1, 0.1}, 20.0};
inline constexpr MakerArm kOmega7{35, "omega.7 (right-hand)", 1.04, 0.62, {0.7, 0.6, 0.6}, 12.0};
inline constexpr MakerArm kSigma7{104, "sigma.7 (right-hand)", 1.17, 1.38, {1.5, 1.3, 1.3}, 20.0};

/// One millisecond of the device. All forces are those on the hand.
struct MakerMoment {
  Vec3 motors_n;  ///< of the motors alone
  Vec3 tip_n;     ///< what the tip pushes with: the motors' force, less the arm's weight
  Vec3 hand_n;    ///< what the hand feels, the arm's inertia included
};

struct MakerDhd {
  // Orders.
  std::atomic<bool> calibrated{true};  ///< false: status RESET, until it is true or drdAutoInit
  std::atomic<bool> frozen{false};     ///< the encoders keep what they had
  std::atomic<bool> unplugged{false};
  std::atomic<bool> clamped{false};  ///< the arm stands in a holder, bit-still
  SharedVec hand_m;  ///< where the hand, which trembles by some hundredths of a mm, wants the tip

  // Observations.
  SharedVec tip_m;
  std::atomic<bool> has_force{false};  ///< the device is in its mode FORCE
  std::atomic<bool> had_force{false};  ///< it was, at any time
  std::atomic<int> off_cause{0};       ///< why it is no longer: DHD_FORCE_OFF_*
  std::atomic<long> forceful_ms{0};    ///< milliseconds in which the motors pushed
  std::atomic<long> misuses{0};        ///< calls for a device that is not open
};

/// What the stand-in exports beside the library's own names. The device's time is real until the
/// first step; then it moves in steps alone, in each of which the driver makes one exchange.
struct MakerDhdExports {
  MakerDhd* state;
  void (*reset)();
  /// Returns once the driver has done all that follows from these exchanges of a millisecond each,
  /// or has ended its thread.
  /// \return false if it makes no exchange for a long time
  bool (*step)(int exchanges);
  void (*run_freely)();
  std::string (*calls)();  ///< the names of opening, closing and stopping calls, in order
  /// Before the device is opened: which one it is.
  void (*plug)(const MakerArm& arm);
  /// Between two steps: time in which the host is dead.
  void (*let_pass)(int milliseconds);
  /// \return the newest moments, the oldest first; as many as there are, up to 20,000
  std::vector<MakerMoment> (*moments)(std::size_t count);
};

}  // namespace touchtrial::fakes

extern "C" touchtrial::fakes::MakerDhdExports* maker_dhd_exports();
