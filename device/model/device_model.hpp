/// \file A model of a force-feedback device in virtual time: mass, friction, resolution, delay, motors
/// and structure. Model files state the source of each parameter. Source of the equations:
/// docs/devices/models.md.
#pragma once

#include "core/random.hpp"
#include "core/vec.hpp"
#include "device/haptic_device.hpp"

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace touchtrial::device {

/// The kind of source of a parameter's value.
enum class Confidence {
  opened,      ///< read in a public source
  transcript,  ///< read in a transcript of a paper
  derived,     ///< computed from values of the kinds above
  memory,      ///< remembered, unverified
  guess,       ///< no source
  measured,    ///< measured on this device by `device accept`
};

struct Provenance {
  std::string source;  ///< one line of free text
  Confidence confidence = Confidence::guess;
};

/// The direction of Coulomb friction.
enum class FrictionShape {
  isotropic,  ///< opposite to the velocity
  per_axis,   ///< on each axis of the device frame separately, with the same magnitude
};

/// The compliance of a device's arms and joints: a second mass at the tip, on a spring.
struct StructureModel {
  double stiffness_n_per_mm = 0.0;  ///< in [0, 1000]; 0: rigid
  double tip_share = 0.0;           ///< of the mass that is at the tip, in (0, 1) unless rigid
  double damping_ratio = 0.0;       ///< of the tip while the motors are held, in [0, 2]
};

/// The parameters of a device. A parameter of zero disables its stage, so a default model is ideal.
struct DeviceModel {
  std::string name;   ///< of a shipped model or a lab's model
  std::string title;  ///< for people: "3D Systems Touch"; may be empty

  double mass_kg = 0.0;            ///< as felt at the tip, without the hand, in [0, 5]
  double viscous_n_s_per_m = 0.0;  ///< friction in proportion to speed, in [0, 100]
  double coulomb_n = 0.0;          ///< friction that does not depend on speed, in [0, 10]
  double static_n = 0.0;           ///< friction at rest, coulomb_n .. 10; 0: as coulomb_n
  double stribeck_mm_s = 0.0;      ///< the speed over which static falls to Coulomb friction
  FrictionShape friction = FrictionShape::isotropic;

  double position_step_mm = 0.0;  ///< readings are multiples of it, in [0, 1]
  /// The reported velocity is the slope of the line through this many readings, 2 to 32; 0: the
  /// true velocity.
  int velocity_readings = 0;

  double force_step_n = 0.0;        ///< forces are multiples of it on each axis, in [0, 1]
  double max_force_n = 0.0;         ///< of the force's norm, in [0, 100]; 0: no limit
  double continuous_force_n = 0.0;  ///< sustainable without time limit, in [0, 100]; 0: unknown
  int delay_ticks = 0;              ///< from a command to its force, 0 to 100
  double lowpass_hz = 0.0;  ///< of the motors and their amplifiers, first order, in [0, 5000]
  /// A force acts throughout the tick, as in a real device, so a wall returns more energy than it
  /// received. If false, the velocity after the tick moves the tip. A structure implies true.
  bool zero_order_hold = false;

  StructureModel structure;
  std::optional<Workspace> workspace;   ///< device frame; nothing: unknown, no stops
  double max_stiffness_n_per_mm = 0.0;  ///< as stated by the maker, in [0, 100]; 0: unknown

  /// Its keys are the parameters' keys in the file ("mass_kg", "structure").
  std::map<std::string, Provenance> provenance;

  /// Faults of a broken specimen, for rehearsals only: the shipped models have none.
  struct PlantedFaults {
    Vec3 force_sign_scale = {1.0, 1.0, 1.0};  ///< factors of the delivered force, in [-10, 10]
    double position_noise_mm = 0.0;  ///< standard deviation of white noise on each axis, in [0, 1]
    double gravity_n = 0.0;          ///< uncompensated weight along -y, in [0, 10]
    double silent_after_s = 0.0;     ///< when readings begin to repeat and forces stop; 0: never
    double lost_after_s = 0.0;       ///< when the link is lost and forces stop; 0: never
    std::uint64_t seed = 1;          ///< of the noise
  } planted_faults;
};

/// \throws std::invalid_argument naming a parameter that is out of range, and its range
void check_device_model(const DeviceModel& model);

/// Reads a file of the schema config/schema/device-model.schema.json.
/// \throws StudyError with the JSON pointer if it breaks the schema, FileError if it cannot be read
[[nodiscard]] DeviceModel read_device_model(const std::filesystem::path& file);

/// The same from text.
/// \param source  names the origin in errors
/// \throws StudyError with the JSON pointer if the text breaks the schema
[[nodiscard]] DeviceModel parse_device_model(std::string_view text, const std::string& source);

/// \return the model as JSON for parse_device_model, without parameters that are zero
[[nodiscard]] std::string device_model_json(const DeviceModel& model);

/// \return the models that the program ships, sorted by name
[[nodiscard]] const std::vector<DeviceModel>& shipped_device_models();

/// \param name  of a shipped model, or a file's path: one that has a slash or ends in ".json"
/// \throws UsageError naming the nearest model if no model has this name; as read_device_model
[[nodiscard]] DeviceModel device_model(const std::string& name);

/// \return the contents of config/devices at build time
[[nodiscard]] std::vector<std::string_view> built_in_device_models();

[[nodiscard]] std::string_view name_of(Confidence confidence) noexcept;

/// A device and its tip, tick by tick, in any right-handed frame. Per-axis friction and noise act
/// on this frame's axes. A tick does not allocate, lock or throw. Not thread-safe.
class DeviceDynamics {
 public:
  /// The tip's mass if neither the model nor the hand has any, kg.
  static constexpr double kMinMassKg = 0.03;

  /// Starts at rest at the origin.
  /// \param tick_s  duration of a tick, in (0, 0.01]
  /// \throws std::invalid_argument if a parameter or the tick is out of range
  explicit DeviceDynamics(const DeviceModel& model, double tick_s = 0.001);

  /// The position as a driver reads it: quantised, with noise.
  [[nodiscard]] const Vec3& read_position_mm() const noexcept { return read_mm_; }
  /// The velocity as a driver estimates it; the true one without velocity_readings.
  [[nodiscard]] const Vec3& read_velocity_mm_s() const noexcept { return read_mm_s_; }
  /// The tip's true state.
  [[nodiscard]] const Vec3& true_position_mm() const noexcept { return tip_mm_; }
  [[nodiscard]] const Vec3& true_velocity_mm_s() const noexcept { return tip_mm_s_; }
  /// The motors' force during the last tick.
  [[nodiscard]] Vec3 delivered_force_n() const noexcept { return delivered_n_; }

  /// Moves the device to this position, at rest, and discards delayed forces.
  void place(Vec3 position_mm) noexcept;

  /// The external load on the tip: a hand, a weight, or a real wall.
  struct TipLoad {
    Vec3 force_n{};
    double mass_kg = 0.0;       ///< mass that moves with the tip, >= 0
    Vec3 damping_n_s_per_mm{};  ///< of the tip's velocity on each axis, >= 0; integrated implicitly
  };

  /// Advances by one tick: applies the command and the load, and updates the readings.
  void tick(Vec3 commanded_n, const TipLoad& load) noexcept;
  /// \return whether the device is a mass with viscous damping and nothing else
  [[nodiscard]] bool is_plain() const noexcept { return is_plain_; }
  /// `tick` of a plain device.
  void tick_plain(Vec3 commanded_n, const TipLoad& load) noexcept {
    delivered_n_ = commanded_n;
    move_rigid(commanded_n, load);
    read_mm_ = tip_mm_;
    read_mm_s_ = tip_mm_s_;
  }

 private:
  static constexpr double kMmPerM = 1000.0;
  static constexpr double kMPerMm = 0.001;

  [[nodiscard]] Vec3 motor_force_n(const Vec3& commanded_n) noexcept;
  [[nodiscard]] Vec3 apply_friction(const Vec3& velocity_mm_s, const Vec3& stop_n,
                                    const Vec3& free_mm_s) const noexcept;
  [[nodiscard]] double friction_n(double speed_mm_s) const noexcept;
  void move_rigid(const Vec3& force_n, const TipLoad& load) noexcept;
  void move_structure(const Vec3& motor_n, const TipLoad& load) noexcept;
  void take_reading() noexcept;
  /// Applies noise, quantisation and velocity estimation to the true position.
  void update_reading() noexcept;
  void estimate_velocity() noexcept;

  DeviceModel model_;
  double tick_s_;
  double static_n_;            ///< effective, never below coulomb_n
  double filter_share_ = 1.0;  ///< of a command's change that the low-pass follows in a tick
  bool has_motors_;            ///< whether any stage changes the command
  bool has_friction_;
  bool has_true_readings_;
  bool is_plain_ = false;
  double tip_kg_ = 0.0;  ///< the structure's share of the mass
  double joint_ = 0.0;   ///< N s/mm: the structure's spring and damper over half a tick; 0: rigid
  std::optional<RandomStream> noise_;

  std::vector<Vec3> delayed_n_;  ///< a ring of delay_ticks commands
  std::size_t next_command_ = 0;
  Vec3 filtered_n_;
  Vec3 delivered_n_;

  Vec3 tip_mm_;
  Vec3 tip_mm_s_;
  Vec3 motor_mm_;  ///< where the encoders measure; equals the tip's without a structure
  Vec3 motor_mm_s_;

  Vec3 read_mm_;
  Vec3 read_mm_s_;
  std::vector<Vec3> readings_mm_;  ///< a ring of velocity_readings
  std::size_t next_reading_ = 0;
};

// Inlined into the hand's tick, because every simulated tick moves two devices.

inline void DeviceDynamics::tick(Vec3 commanded_n, const TipLoad& load) noexcept {
  delivered_n_ = has_motors_ ? motor_force_n(commanded_n) : commanded_n;
  Vec3 motor_n = delivered_n_;
  if (model_.planted_faults.gravity_n > 0.0) motor_n.y -= model_.planted_faults.gravity_n;
  if (joint_ > 0.0) {
    move_structure(motor_n, load);
  } else {
    move_rigid(motor_n, load);
  }
  take_reading();
}

inline void DeviceDynamics::move_rigid(const Vec3& force_n, const TipLoad& load) noexcept {
  const double mass_kg = model_.mass_kg + load.mass_kg;
  const double tick_per_mass = tick_s_ * kMmPerM / (mass_kg > 0.0 ? mass_kg : kMinMassKg);
  const double viscous = kMPerMm * model_.viscous_n_s_per_m;
  const Vec3 total_n = force_n + load.force_n;
  const auto free_velocity = [=](double before_mm_s, double n, double damping) {
    return (before_mm_s + tick_per_mass * n) / (1.0 + tick_per_mass * (viscous + damping));
  };
  const Vec3 damping = load.damping_n_s_per_mm;
  Vec3 after_mm_s{free_velocity(tip_mm_s_.x, total_n.x, damping.x),
                  free_velocity(tip_mm_s_.y, total_n.y, damping.y),
                  free_velocity(tip_mm_s_.z, total_n.z, damping.z)};
  if (has_friction_) {
    after_mm_s = apply_friction(tip_mm_s_, total_n + (1.0 / tick_per_mass) * tip_mm_s_, after_mm_s);
  }
  const Vec3 mean_mm_s = model_.zero_order_hold ? 0.5 * (tip_mm_s_ + after_mm_s) : after_mm_s;
  tip_mm_ = tip_mm_ + tick_s_ * mean_mm_s;
  tip_mm_s_ = after_mm_s;
}

inline void DeviceDynamics::take_reading() noexcept {
  read_mm_ = copy_by_component(joint_ > 0.0 ? motor_mm_ : tip_mm_);
  if (has_true_readings_) {
    read_mm_s_ = copy_by_component(joint_ > 0.0 ? motor_mm_s_ : tip_mm_s_);
  } else {
    update_reading();
  }
}

/// A modelled device with the driver interface, in the device frame and in virtual time: each
/// `write` is one tick of 1 ms. It stops at the ends of the model's workspace, if any. Any thread
/// may call `halt`; the other functions belong to one thread. Without a hand the handle is free.
class ModelledDevice final : public HapticDevice {
 public:
  using Hand =
      std::function<DeviceDynamics::TipLoad(double time_s, Vec3 position_mm, Vec3 velocity_mm_s)>;

  /// The handle rests in the middle of the workspace, or at the origin without one.
  /// \throws std::invalid_argument if a parameter is out of range
  explicit ModelledDevice(DeviceModel model, Hand hand = {});

  /// Sets the load on the handle from the next tick on: called once per tick with the tip's true
  /// state; must not throw.
  void set_hand(Hand hand) { hand_ = std::move(hand); }
  void place(Vec3 position_mm) noexcept { dynamics_.place(position_mm); }

  [[nodiscard]] const DeviceModel& model() const noexcept { return model_; }
  [[nodiscard]] const DeviceDynamics& dynamics() const noexcept { return dynamics_; }
  /// \return the virtual time since construction
  [[nodiscard]] std::chrono::nanoseconds now() const noexcept;

  /// The driver's name is "modelled"; a model without a peak force has the maximum force of
  /// SafetyLimits.
  [[nodiscard]] DeviceInfo info() const override;
  [[nodiscard]] DeviceStatus read(DeviceSample& sample) noexcept override;
  [[nodiscard]] DeviceStatus write(Vec3 force_n) noexcept override;
  void halt() noexcept override { halted_ = true; }
  void rearm() noexcept override { halted_ = false; }
  [[nodiscard]] DeviceFault fault() const noexcept override;

 private:
  [[nodiscard]] double time_s() const noexcept;
  [[nodiscard]] bool is_silent() const noexcept;
  [[nodiscard]] bool is_lost() const noexcept;

  DeviceModel model_;
  DeviceDynamics dynamics_;
  Hand hand_;
  std::int64_t tick_ = 0;
  DeviceSample last_sample_;  ///< repeated when the device is silent
  std::atomic<bool> halted_{false};
};

}  // namespace touchtrial::device
