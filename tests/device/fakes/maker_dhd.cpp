// A stand-in for Force Dimension's library with its real names, libdrd's included. It is written
// from outside facts, in our words, and shares no declaration with the driver, so that a slip in
// either shows. Each behaviour names its source:
// [header]    dhdc.h and drdc.h of the SDK 3.17.5: names, types, values
// [text]      the SDK's documentation, also as Python's forcedimension_core repeats it
// [observed]  what the library 3.17.5 does, with its own simulator in place of a device
// [assumed]   nobody says so; the strictest that is plausible
#include "device/fakes/maker_dhd.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <numbers>
#include <optional>

namespace touchtrial::fakes {
namespace {

using Clock = std::chrono::steady_clock;
using Joints = std::array<double, 3>;  // rad

constexpr double kSubstepS = 0.00025;
constexpr int kSubstepsOfMs = 4;
/// A driver that calls nothing for so long has ended.
constexpr std::chrono::seconds kPatience{20};

enum Error { kNoError = 0, kCom = 2, kNoDevice = 5, kExpert = 9 };  // [header]
constexpr int kTimeGuard = 1;                                       // [header]
constexpr int kSaturated = 2;                                       // [header]
enum OffCause { kByWatchdog = 3, kBySoftware = 4, kByUsb = 5 };     // [header]

Vec3 cross(Vec3 a, Vec3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// --- Delta kinematics: three arms around the axis towards the person. The lengths are invented;
// they give an omega.3's step of 0.006 to 0.008 mm [observed].

constexpr double kArmM = 0.09;
constexpr double kForearmM = 0.16;
constexpr double kBaseM = 0.02;      ///< from the axis, less the effector's radius
constexpr double kMiddleM = 0.1162;  ///< of the workspace, in front of the base
constexpr double kCountRad = 1e-4;

Vec3 direction_of(std::size_t arm) {
  const double angle = std::numbers::pi * (2.0 / 3.0 * static_cast<double>(arm) - 0.5);
  return {0.0, std::cos(angle), std::sin(angle)};
}

/// From the elbow to the tip.
Vec3 forearm(std::size_t arm, double angle, Vec3 tip_m) {
  const Vec3 out = (kBaseM + kArmM * std::cos(angle)) * direction_of(arm);
  return tip_m + Vec3{kMiddleM - kArmM * std::sin(angle), 0.0, 0.0} - out;
}

Joints joints_at(Vec3 tip_m) {
  Joints joints{};
  for (std::size_t arm = 0; arm < 3; ++arm) {
    const double x = tip_m.x + kMiddleM;
    const double out = dot(tip_m, direction_of(arm)) - kBaseM;
    const double side_squared = dot({0.0, tip_m.y, tip_m.z}, tip_m) -
                                dot(tip_m, direction_of(arm)) * dot(tip_m, direction_of(arm));
    const double k =
        (out * out + x * x + side_squared + kArmM * kArmM - kForearmM * kForearmM) / (2.0 * kArmM);
    joints.at(arm) = std::atan2(x, out) - std::acos(std::clamp(k / std::hypot(out, x), -1.0, 1.0));
  }
  return joints;
}

/// \return x with rows * x = right
Vec3 solve(const std::array<Vec3, 3>& rows, Vec3 right) {
  const Vec3 a = cross(rows[1], rows[2]);
  const Vec3 b = cross(rows[2], rows[0]);
  const Vec3 c = cross(rows[0], rows[1]);
  return (1.0 / dot(rows[0], a)) * (right.x * a + right.y * b + right.z * c);
}

std::array<Vec3, 3> forearms(const Joints& joints, Vec3 tip_m) {
  return {forearm(0, joints[0], tip_m), forearm(1, joints[1], tip_m), forearm(2, joints[2], tip_m)};
}

/// By Newton's method, from the middle.
Vec3 tip_at(const Joints& joints) {
  Vec3 tip_m;
  for (int i = 0; i < 20; ++i) {
    const std::array<Vec3, 3> rows = forearms(joints, tip_m);
    const auto excess = [&](std::size_t arm) {
      return 0.5 * (dot(rows.at(arm), rows.at(arm)) - kForearmM * kForearmM);
    };
    const Vec3 step_m = solve(rows, {excess(0), excess(1), excess(2)});
    tip_m = tip_m - step_m;
    if (norm(step_m) < 1e-12) break;
  }
  return tip_m;
}

/// Column `arm`: the tip's motion by this joint, m/rad.
Vec3 jacobian_column(const Joints& joints, std::size_t arm) {
  const std::array<Vec3, 3> rows = forearms(joints, tip_at(joints));
  const double angle = joints.at(arm);
  const Vec3 elbow =
      kArmM * (std::cos(angle) * Vec3{1.0, 0.0, 0.0} - std::sin(angle) * direction_of(arm));
  const double right = dot(rows.at(arm), elbow);
  return solve(rows, {arm == 0 ? right : 0.0, arm == 1 ? right : 0.0, arm == 2 ? right : 0.0});
}

// --- The device and the hand.

Vec3 within(Vec3 force_n, double most_n) {
  const double size_n = norm(force_n);
  return size_n > most_n ? (most_n / size_n) * force_n : force_n;
}

Vec3 by_axis(Vec3 force_n, Vec3 mass_kg) {
  return {force_n.x / mass_kg.x, force_n.y / mass_kg.y, force_n.z / mass_kg.z};
}

/// Holds the tip like a light grip, and trembles.
struct Hand {
  static constexpr double kStiffnessNPerM = 600.0;
  static constexpr double kDampingNsPerM = 12.0;
  static constexpr double kTremorM = 0.00004;

  [[nodiscard]] static Vec3 force_n(Vec3 wanted_m, Vec3 tip_m, Vec3 velocity, double time_s) {
    const double turn = 2.0 * std::numbers::pi * time_s;
    const Vec3 tremor = {std::sin(9.0 * turn), std::sin(8.3 * turn + 1.0),
                         std::sin(10.1 * turn + 2.0)};
    return kStiffnessNPerM * (wanted_m + kTremorM * tremor - tip_m) - kDampingNsPerM * velocity;
  }
};

/// Never destroyed, as the driver keeps the library loaded for ever.
alignas(MakerDhd) std::array<std::byte, sizeof(MakerDhd)> room;
MakerDhd* const state = new (room.data()) MakerDhd;

/// Arm, controller and library.
class Device {
 public:
  void plug(const MakerArm& arm) { arm_ = arm; }

  /// \param is_watched  whether the device's watchdog counts this time
  void pass(double seconds, bool is_watched) {
    left_over_s_ += seconds;
    while (left_over_s_ >= 0.5 * kSubstepS) {
      left_over_s_ -= kSubstepS;
      substep(is_watched);
    }
  }

  [[nodiscard]] bool exchange(std::optional<Vec3> force_n) {
    notice_orders();
    if (state->unplugged) return false;
    if (force_n) {
      motors_n_ = *force_n;
      silent_s_ = 0.0;
    }
    if (!state->frozen) encoders_ = joints_in_counts();
    read_s_ = time_s_;
    return true;
  }

  /// \return what dhdSetForce returns
  int set_force(Vec3 force_n) {
    // The limit holds for what the application asks for; what carries the arm comes on top, as long
    // as the motors can [observed].
    const Vec3 asked_n = max_force_n_ >= 0.0 ? within(force_n, max_force_n_) : force_n;
    const Vec3 all_n = asked_n + Vec3{0.0, 0.0, compensation_n()};
    const Vec3 given_n = within(all_n, arm_.motors_n);
    if (!exchange(given_n)) return -1;
    return given_n == all_n ? 0 : kSaturated;
  }

  [[nodiscard]] bool is_recent() const { return time_s_ - read_s_ < guard_s_; }
  [[nodiscard]] Joints joints() const {
    return {kCountRad * static_cast<double>(encoders_[0]),
            kCountRad * static_cast<double>(encoders_[1]),
            kCountRad * static_cast<double>(encoders_[2])};
  }

  /// What the library adds to each force, N. It follows the switch within 250 ms [observed].
  [[nodiscard]] double compensation_n() const {
    return compensated_share_ * (arm_.links_n + 9.81 * library_kg_);
  }

  void enable_force(bool on) {
    notice_orders();
    motors_n_ = {};
    silent_s_ = 0.0;
    // A device that waits for calibration takes the call and stays as it is [observed].
    if (on && !is_reset_) {
      set_mode(true, state->off_cause);
    } else if (!on && state->has_force) {
      set_mode(false, kBySoftware);
    }
  }

  void give_status(int* status) {
    notice_orders();
    const bool force = state->has_force;
    // [header] the places, [observed] what a device without wrist has in each.
    const std::array<int, 17> all = {1,
                                     1,
                                     1,
                                     is_reset_ ? 1 : 0,
                                     0,
                                     force ? 1 : 0,
                                     force ? 0 : 1,
                                     0,
                                     0,
                                     0,
                                     is_compensated_ ? 1 : 0,
                                     guard_s_ > 0.0 ? 1 : 0,
                                     0,
                                     0,
                                     state->off_cause,
                                     -1,
                                     0};
    std::copy(all.begin(), all.end(), status);
  }

  void calibrate() {
    state->calibrated = true;
    notice_orders();
  }

  /// As it comes out of its box: on opening, the library's settings are the maker's.
  void open() {
    is_compensated_ = true;  // [text]
    compensated_share_ = 1.0;
    library_kg_ = arm_.effector_kg;
    max_force_n_ = -1.0;
    guard_s_ = kUsualGuardS;
    (void)exchange(std::nullopt);
  }

  void set_guard_us(int us) { guard_s_ = us < 0 ? kUsualGuardS : 1e-6 * us; }  // [text]
  void set_compensated(bool on) { is_compensated_ = on; }
  void set_max_force_n(double most_n) { max_force_n_ = most_n; }  // [text] negative: none
  /// A mass below zero is that of the device's memory again [observed].
  void set_effector_kg(double kg) { library_kg_ = kg < 0.0 ? arm_.effector_kg : kg; }
  [[nodiscard]] double effector_kg() const { return library_kg_; }
  void set_watchdog(std::uint8_t units) { watchdog_ = units; }
  [[nodiscard]] std::uint8_t watchdog() const { return watchdog_; }
  [[nodiscard]] const MakerArm& arm() const { return arm_; }

  [[nodiscard]] std::vector<MakerMoment> moments(std::size_t count) const {
    const auto kept = static_cast<std::ptrdiff_t>(std::min(count, moments_.size()));
    return {moments_.end() - kept, moments_.end()};
  }

 private:
  static constexpr double kUsualGuardS = 0.002;   // [observed]
  static constexpr double kRampS = 0.25;          // [observed]
  static constexpr double kWatchdogS = 0.000125;  // [text]
  static constexpr double kBrakesNsPerM = 20.0;   // viscous [text], how much [assumed]
  static constexpr double kReachM = 0.075;
  static constexpr std::size_t kMostMoments = 20'000;

  void substep(bool is_watched) {
    notice_orders();
    time_s_ += kSubstepS;
    const double turn = kSubstepS / kRampS;
    compensated_share_ =
        std::clamp(compensated_share_ + (is_compensated_ ? turn : -turn), 0.0, 1.0);
    watch(is_watched);
    move();
    if (++substeps_ % kSubstepsOfMs == 0) keep_moment();
  }

  /// Forces go off if none was sent for longer than the watchdog's time [text].
  void watch(bool is_watched) {
    if (!is_watched) return;
    silent_s_ += kSubstepS;
    if (state->has_force && watchdog_ > 0 && silent_s_ > kWatchdogS * watchdog_) {
      set_mode(false, kByWatchdog);
    }
  }

  void move() {
    const Vec3 tip_m = state->tip_m.get();
    hand_n_ = {};
    if (state->clamped) {
      hand_n_ = tip_n();
      velocity_ = {};
      return;
    }
    Vec3 all_n = tip_n() - (state->has_force ? 0.5 : kBrakesNsPerM) * velocity_ + stop_n(tip_m);
    const Vec3 grip_n = Hand::force_n(state->hand_m.get(), tip_m, velocity_, time_s_);
    hand_n_ = -1.0 * grip_n;
    all_n = all_n + grip_n;
    velocity_ = velocity_ + kSubstepS * by_axis(all_n, arm_.inertia_kg);
    state->tip_m.set(tip_m + kSubstepS * velocity_);
  }

  /// Of the arm's mechanical stops.
  [[nodiscard]] Vec3 stop_n(Vec3 tip_m) const {
    const double beyond_m = norm(tip_m) - kReachM;
    if (beyond_m <= 0.0) return {};
    return (-5000.0 * beyond_m / norm(tip_m)) * tip_m - 50.0 * velocity_;
  }

  [[nodiscard]] Vec3 motors_n() const { return state->has_force ? motors_n_ : Vec3{}; }
  [[nodiscard]] Vec3 tip_n() const { return motors_n() - Vec3{0.0, 0.0, arm_.weight_n()}; }

  void keep_moment() {
    if (motors_n() != Vec3{}) ++state->forceful_ms;
    moments_.push_back({motors_n(), tip_n(), hand_n_});
    if (moments_.size() > kMostMoments) moments_.pop_front();
  }

  void notice_orders() {
    is_reset_ = !state->calibrated;
    if (is_reset_ && state->has_force) set_mode(false, kBySoftware);
    // The controller sees that the cable is gone [header: DHD_FORCE_OFF_USBDISCN].
    if (state->unplugged && state->has_force) set_mode(false, kByUsb);
  }

  /// Forces or brakes. What the motors were told before is forgotten [observed].
  void set_mode(bool force, int cause) {
    motors_n_ = {};
    state->has_force = force;
    state->had_force = state->had_force || force;
    state->off_cause = cause;
  }

  [[nodiscard]] std::array<long, 3> joints_in_counts() const {
    const Joints joints = joints_at(state->tip_m.get());
    return {std::lround(joints[0] / kCountRad), std::lround(joints[1] / kCountRad),
            std::lround(joints[2] / kCountRad)};
  }

  MakerArm arm_;
  double time_s_ = 0.0;
  double left_over_s_ = 0.0;
  long substeps_ = 0;
  Vec3 velocity_;  ///< of the tip, m/s
  Vec3 motors_n_;  ///< as told; on the tip only in the mode FORCE
  Vec3 hand_n_;
  bool is_reset_ = false;
  double silent_s_ = 0.0;
  std::uint8_t watchdog_ = 0;
  std::array<long, 3> encoders_{};
  double read_s_ = -1.0;
  double guard_s_ = kUsualGuardS;
  bool is_compensated_ = true;
  double compensated_share_ = 1.0;
  double library_kg_ = 0.0;
  double max_force_n_ = -1.0;
  std::deque<MakerMoment> moments_;
};

/// The library, its lock, and its pace.
struct Inside {
  CallLog calls;
  std::mutex mutex;  ///< of the following
  std::condition_variable changed;
  Device device;
  bool is_open = false;
  bool is_robotic = false;  ///< opened by drdOpenID
  bool is_expert = false;
  bool has_read = false;  ///< since the last force
  long reads = 0;
  std::optional<Clock::time_point>
      free_since;  ///< the device's time follows the real one from here
  bool is_free = true;
  int permits = 0;
  long done = 0;
  bool in_step = false;
  bool has_left = false;  ///< the thread that made exchanges has ended
  bool is_idle = false;   ///< it makes none, without an end
};
Inside& inside() {
  static Inside* const kInside = new Inside;
  return *kInside;
}

thread_local int last_error = kNoError;

int fail(Error error) {
  last_error = error;
  return -1;
}

void end_step() {
  if (!inside().in_step) return;
  inside().in_step = false;
  ++inside().done;
  inside().changed.notify_all();
}

/// Notes that a thread that made exchanges ends.
struct Presence {
  bool makes_exchanges = false;
  ~Presence() {
    if (!makes_exchanges) return;
    const std::lock_guard lock(inside().mutex);
    inside().has_left = true;
    end_step();
    inside().changed.notify_all();
  }
};
thread_local Presence presence;

/// While the device's time is real, it follows.
void follow_real_time() {
  if (!inside().is_free) return;
  const Clock::time_point now = Clock::now();
  if (inside().free_since) {
    // The host may be slow for the machine's sake, so the watchdog looks away.
    inside().device.pass(std::chrono::duration<double>(now - *inside().free_since).count(), false);
  }
  inside().free_since = now;
}

/// Waits for the moment of the next exchange.
void await_exchange(std::unique_lock<std::mutex>& lock) {
  Inside& all = inside();
  presence.makes_exchanges = true;
  all.is_idle = false;
  end_step();
  all.changed.notify_all();
  all.changed.wait(lock, [&] { return all.is_free || all.permits > 0; });
  if (!all.is_free) {
    --all.permits;
    all.in_step = true;
    all.free_since.reset();
    all.device.pass(1e-3, true);
    return;
  }
  lock.unlock();
  std::this_thread::sleep_for(std::chrono::microseconds(200));
  lock.lock();
  follow_real_time();
}

bool step(int exchanges) {
  Inside& all = inside();
  std::unique_lock lock(all.mutex);
  // The step before is over once the driver waits for the next exchange.
  all.is_free = false;
  all.permits += exchanges;
  const long goal = all.done + exchanges + (all.in_step ? 1 : 0);
  all.changed.notify_all();
  const bool came = all.changed.wait_for(
      lock, kPatience, [&] { return all.done >= goal || all.has_left || all.is_idle; });
  all.is_idle = all.is_idle || !came;
  if (all.done >= goal) return true;
  // Nobody takes what is left; the device's time goes on.
  all.device.pass(1e-3 * std::max(all.permits, 0), true);
  all.permits = 0;
  return all.has_left;
}

void run_freely() {
  const std::lock_guard lock(inside().mutex);
  inside().is_free = true;
  inside().permits = 0;
  inside().changed.notify_all();
}

void reset() {
  const std::lock_guard lock(inside().mutex);
  inside().calls.clear();
  state->~MakerDhd();
  new (state) MakerDhd;
  inside().device = Device();
  inside().reads = 0;
  inside().has_left = false;
  inside().is_idle = false;
}

/// What a call of the library needs.
enum class Need { cable, expert_mode, device_alone };

/// One call of the library.
class Call {
 public:
  explicit Call(Need need = Need::cable) : lock_(inside().mutex) {
    follow_real_time();
    if (!inside().is_open) {
      error_ = kNoDevice;
      ++state->misuses;
    } else if (need == Need::expert_mode && !inside().is_expert) {
      error_ = kExpert;  // [observed]
    } else if (need != Need::device_alone && state->unplugged) {
      error_ = kCom;
    }
  }
  [[nodiscard]] bool is_refused() const {
    if (error_ != kNoError) last_error = error_;
    return error_ != kNoError;
  }
  [[nodiscard]] std::unique_lock<std::mutex>& lock() { return lock_; }
  [[nodiscard]] Device& device() const { return inside().device; }

 private:
  std::unique_lock<std::mutex> lock_;
  Error error_ = kNoError;
};

int open_device(int id, const char* name, bool is_robotic) {
  const std::lock_guard lock(inside().mutex);
  inside().calls.note(name);
  if (id != 0 || state->unplugged) return fail(kNoDevice);
  // One that is open already keeps its settings and answers with its number [text].
  if (!inside().is_open) inside().device.open();
  inside().is_open = true;
  inside().has_left = false;
  inside().is_robotic = is_robotic;
  return 0;
}

int close_device(const char* name) {
  const std::lock_guard lock(inside().mutex);
  inside().calls.note(name);
  if (!inside().is_open) {
    ++state->misuses;
    return fail(kNoDevice);
  }
  inside().is_open = false;
  return 0;
}

const char* words_for(int error) {
  if (error == kCom) return "communication error";
  if (error == kNoDevice) return "no device found";
  return error == kExpert ? "expert mode disabled" : "no error";
}

}  // namespace
}  // namespace touchtrial::fakes

using namespace touchtrial::fakes;  // NOLINT: what follows is the library's C interface

extern "C" {

/// Tells a bring-up that this is no hardware.
extern const int touchtrial_stand_in;
const int touchtrial_stand_in = 1;

MakerDhdExports* maker_dhd_exports() {
  static MakerDhdExports exports{state,
                                 reset,
                                 step,
                                 run_freely,
                                 [] { return inside().calls.text(); },
                                 [](const MakerArm& arm) {
                                   const std::lock_guard lock(inside().mutex);
                                   inside().device.plug(arm);
                                 },
                                 [](int milliseconds) {
                                   const std::lock_guard lock(inside().mutex);
                                   inside().device.pass(1e-3 * milliseconds, true);
                                 },
                                 [](std::size_t count) {
                                   const std::lock_guard lock(inside().mutex);
                                   return inside().device.moments(count);
                                 }};
  return &exports;
}

int dhdGetDeviceCount() {
  return state->unplugged ? 0 : 1;
}

int dhdOpenID(char id) {
  return open_device(id, "open", false);
}

int dhdClose(char /*id*/) {
  return close_device("close");
}

int drdOpenID(char id) {
  return open_device(id, "drd_open", true);
}

int drdClose(char /*id*/) {
  return close_device("drd_close");
}

bool drdIsInitialized(char /*id*/) {
  const Call call;
  // Of a robot, so only after drdOpenID [observed].
  return !call.is_refused() && inside().is_robotic && state->calibrated;
}

int drdAutoInit(char /*id*/) {
  const Call call;
  if (call.is_refused()) return -1;
  call.device().calibrate();
  return 0;
}

int dhdSetForce(double fx, double fy, double fz, char /*id*/) {
  Call call(Need::device_alone);  // without a cable, too, an exchange takes its time
  if (call.is_refused()) return -1;
  await_exchange(call.lock());
  inside().has_read = false;
  const int result = call.device().set_force({fx, fy, fz});
  return result < 0 ? fail(kCom) : result;
}

/// Exchanges nothing if the newest exchange, that of a force included, is younger than the guard's
/// time [text, observed]; now and then the host is late enough that it is older [observed].
int dhdGetPosition(double* px, double* py, double* pz, char /*id*/) {
  Call call(Need::device_alone);
  if (call.is_refused()) return -1;
  if (inside().has_read) await_exchange(call.lock());
  inside().has_read = true;
  const bool is_late = ++inside().reads % 100 == 0;
  const bool is_guarded = call.device().is_recent() && !is_late;
  if (!is_guarded && !call.device().exchange(std::nullopt)) return fail(kCom);
  const touchtrial::Vec3 tip_m = tip_at(call.device().joints());
  *px = tip_m.x;
  *py = tip_m.y;
  *pz = tip_m.z;
  return is_guarded ? kTimeGuard : 0;
}

int dhdEnableForce(unsigned char on, char /*id*/) {
  const Call call;
  inside().calls.note(on != 0 ? "force_on" : "force_off");
  if (call.is_refused()) return -1;
  call.device().enable_force(on != 0);
  return 0;
}

int dhdStop(char /*id*/) {
  const Call call;
  inside().calls.note("stop");
  if (call.is_refused()) return -1;
  call.device().enable_force(false);
  return 0;
}

unsigned int dhdGetButtonMask(char /*id*/) {
  const Call call;
  (void)call.is_refused();
  return 0;
}

int dhdGetStatus(int* status, char /*id*/) {
  const Call call;
  if (call.is_refused()) return -1;
  call.device().give_status(status);
  return 0;
}

int dhdEnableExpertMode() {
  const std::lock_guard lock(inside().mutex);
  inside().is_expert = true;
  return 0;
}

int dhdDisableExpertMode() {
  const std::lock_guard lock(inside().mutex);
  inside().is_expert = false;
  return 0;
}

int dhdSetTimeGuard(int us, char /*id*/) {
  const Call call(Need::expert_mode);
  if (call.is_refused()) return -1;
  call.device().set_guard_us(us);
  return 0;
}

int dhdSetGravityCompensation(int on, char /*id*/) {
  const Call call;
  if (call.is_refused()) return -1;
  call.device().set_compensated(on == 1);  // [observed]
  return 0;
}

const char* dhdErrorGetLastStr() {
  return words_for(last_error);
}

int dhdGetSystemType(char /*id*/) {
  const Call call;
  return call.is_refused() ? -1 : call.device().arm().type;
}

const char* dhdGetSystemName(char /*id*/) {
  const Call call;
  return call.is_refused() ? nullptr : call.device().arm().name;
}

int dhdGetSerialNumber(unsigned short* number, char /*id*/) {
  const Call call;
  if (call.is_refused()) return -1;
  *number = 1234;
  return 0;
}

int dhdGetVersion(double* version, char /*id*/) {
  const Call call;
  if (call.is_refused()) return -1;
  *version = 2.0;
  return 0;
}

int dhdSetEffectorMass(double kg, char /*id*/) {
  const Call call;
  if (call.is_refused()) return -1;
  call.device().set_effector_kg(kg);
  return 0;
}

int dhdGetEffectorMass(double* kg, char /*id*/) {
  const Call call;
  if (call.is_refused()) return -1;
  *kg = call.device().effector_kg();
  return 0;
}

int dhdSetMaxForce(double most_n, char /*id*/) {
  const Call call;
  if (call.is_refused()) return -1;
  call.device().set_max_force_n(most_n);
  return 0;
}

int dhdSetWatchdog(unsigned char units, char /*id*/) {
  const Call call(Need::expert_mode);
  if (call.is_refused()) return -1;
  call.device().set_watchdog(units);
  return 0;
}

int dhdGetWatchdog(unsigned char* units, char /*id*/) {
  const Call call(Need::expert_mode);
  if (call.is_refused()) return -1;
  *units = call.device().watchdog();
  return 0;
}

int dhdGetJointAngles(double* angles, char /*id*/) {
  const Call call(Need::expert_mode);
  if (call.is_refused()) return -1;
  const Joints joints = call.device().joints();
  std::fill(angles, angles + 8, 0.0);  // [header] DHD_MAX_DOF
  std::copy(joints.begin(), joints.end(), angles);
  return 0;
}

int dhdGetDeltaJointAngles(double* j0, double* j1, double* j2, char /*id*/) {
  const Call call(Need::expert_mode);
  if (call.is_refused()) return -1;
  const Joints joints = call.device().joints();
  *j0 = joints[0];
  *j1 = joints[1];
  *j2 = joints[2];
  return 0;
}

/// Rows are those of the tip's x, y and z [observed].
int dhdDeltaJointAnglesToJacobian(double j0, double j1, double j2, double jacobian[3][3],
                                  char /*id*/) {
  const Call call(Need::expert_mode);
  if (call.is_refused()) return -1;
  for (std::size_t arm = 0; arm < 3; ++arm) {
    const touchtrial::Vec3 column = jacobian_column({j0, j1, j2}, arm);
    jacobian[0][arm] = column.x;
    jacobian[1][arm] = column.y;
    jacobian[2][arm] = column.z;
  }
  return 0;
}

/// What the library adds for the arm's weight at present, so nothing once its compensation is off
/// for 250 ms [observed].
int dhdDeltaGravityJointTorques(double j0, double j1, double j2, double* q0, double* q1, double* q2,
                                char /*id*/) {
  const Call call(Need::expert_mode);
  if (call.is_refused()) return -1;
  const double up_n = call.device().compensation_n();
  *q0 = up_n * jacobian_column({j0, j1, j2}, 0).z;
  *q1 = up_n * jacobian_column({j0, j1, j2}, 1).z;
  *q2 = up_n * jacobian_column({j0, j1, j2}, 2).z;
  return 0;
}

int dhdJointAnglesToGravityJointTorques(const double* angles, double* torques,
                                        unsigned char /*mask*/, char id) {
  std::fill(torques, torques + 8, 0.0);
  return dhdDeltaGravityJointTorques(angles[0], angles[1], angles[2], torques, torques + 1,
                                     torques + 2, id);
}

}  // extern "C"
