#include "device/drivers/mouse/mouse_device.hpp"

#include "core/errors.hpp"
#include "device/drivers/drivers.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <stdexcept>

namespace touchtrial::device {
namespace {

/// Mass of hand and stylus normal to the plane: 0.1 kg in N s^2/mm.
constexpr double kMass = 1e-4;
/// Nearly critical on the usual wall of 0.4 N/mm.
constexpr double kDamping_n_s_per_mm = 0.012;
constexpr double kHoverStiffness_n_per_mm = 0.4;
/// Limits the motion after a stall of the servo.
constexpr ServoClock::Time kMaxStep = std::chrono::milliseconds(20);
constexpr double kMaxSubstepS = 0.001;
/// After a longer pause, as between planes, the hand starts again above the plane.
constexpr ServoClock::Time kMaxReadPause = std::chrono::milliseconds(200);

double seconds(ServoClock::Time time) noexcept {
  return std::chrono::duration<double>(time).count();
}

/// \return the vector, scaled down to `max` if it is longer
Vec2 clamp_length(Vec2 vector, double max) noexcept {
  const double length = norm(vector);
  return length > max ? (max / length) * vector : vector;
}

double smooth_step(double share) noexcept {
  return share * share * (3.0 - 2.0 * share);
}

void check(const MouseOptions& o) {
  for (const double value : {o.pull_n_per_mm, o.max_pull_n, o.pull_time_s, o.pointer_time_s,
                             o.max_speed_mm_s, o.push_n, o.push_time_s, o.hover_mm}) {
    if (!(value > 0.0) || !std::isfinite(value)) {
      throw std::invalid_argument("MouseDevice: an option is out of range");
    }
  }
}

std::string environment_value(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

std::vector<DeviceListing> list_mouse(const DeviceSettings&) {
  DeviceListing listing;
  listing.driver = kMouseDriver;
  const std::string wayland = environment_value("WAYLAND_DISPLAY");
  listing.where = wayland.empty() ? environment_value("DISPLAY") : wayland;
  listing.present = !listing.where.empty();
  if (listing.present) {
    listing.model = "pointer on a screen";
  } else {
    listing.missing = {
        "no display: neither DISPLAY nor WAYLAND_DISPLAY is set; run in a graphical session"};
  }
  return {listing};
}

std::unique_ptr<HapticDevice> refuse_without_window(const DeviceSettings&) {
  throw DeviceError(
      "mouse: needs a participant's window, which this command does not open; try it in a session, "
      "with touchtrial run STUDY --db pilot.db --device mouse --pilot");
}

}  // namespace

MouseDevice::MouseDevice(PointerSource& pointer, ServoClock& clock, const MouseOptions& options)
    : pointer_(pointer),
      clock_(clock),
      options_(options),
      smoothed_(options.pointer_time_s),
      displacement_(options.pull_time_s),
      height_mm_(options.hover_mm) {
  check(options);
}

DeviceInfo MouseDevice::info() const {
  DeviceInfo info;
  info.name = "mouse";
  info.max_force_n = 3.3;
  info.model = "pointer on a screen";
  info.visual = true;
  return info;
}

DeviceFault MouseDevice::fault() const noexcept {
  return closed_.load(std::memory_order_acquire) ? DeviceFault::link_lost : DeviceFault::none;
}

DeviceStatus MouseDevice::read(DeviceSample& sample) noexcept {
  const ServoClock::Time now = clock_.now();
  const double step_s = readings_ == 0 ? 0.0 : seconds(std::clamp(now - last_read_, {}, kMaxStep));
  if (readings_ > 0 && now - last_read_ > kMaxReadPause) raise_hand();
  last_read_ = now;
  update_pointer(pointer_.newest(), now);
  move(step_s);
  const Vec2 position_mm = smoothed_.value() + displacement_.value();
  const Vec2 velocity_mm_s = smoothed_.rate_per_s() + displacement_.rate_per_s();
  sample.position_mm = {position_mm.x, position_mm.y, height_mm_};
  sample.velocity_mm_s = {velocity_mm_s.x, velocity_mm_s.y, rise_mm_s_};
  sample.sequence = ++readings_;
  sample.buttons = pointer_state_.pressed ? 1U : 0U;
  sample.ready = pointer_state_.sequence > 0;
  pointer_.show({position_mm, readings_});
  return pointer_state_.closed ? DeviceStatus::fault : DeviceStatus::ok;
}

DeviceStatus MouseDevice::write(Vec3 force_n) noexcept {
  const bool is_accepted = !halted_.load(std::memory_order_acquire) && is_finite(force_n);
  force_n_ = is_accepted ? force_n : Vec3{};
  return pointer_state_.closed ? DeviceStatus::fault : DeviceStatus::ok;
}

void MouseDevice::update_pointer(const PointerState& pointer, ServoClock::Time now) noexcept {
  if (pointer.sequence != pointer_state_.sequence) last_change_ = now;
  if (pointer_state_.sequence == 0) {
    // The hand starts at the first position of the pointer.
    hand_mm_ = pointer.position_mm;
    smoothed_.reset(hand_mm_);
  }
  pointer_state_ = pointer;
  if (pointer.closed) closed_.store(true, std::memory_order_release);
  is_pressed_ = pointer.pressed && !pointer.closed && now - last_change_ < kTimeout &&
                !halted_.load(std::memory_order_acquire);
}

void MouseDevice::raise_hand() noexcept {
  push_share_ = 0.0;
  force_n_ = {};
  height_mm_ = options_.hover_mm;
  rise_mm_s_ = 0.0;
}

void MouseDevice::move(double step_s) noexcept {
  hand_mm_ = hand_mm_ +
             clamp_length(pointer_state_.position_mm - hand_mm_, options_.max_speed_mm_s * step_s);
  smoothed_.step(hand_mm_, step_s);
  const Vec2 pull_n = clamp_length({force_n_.x, force_n_.y}, options_.max_pull_n);
  displacement_.step((1.0 / options_.pull_n_per_mm) * pull_n, step_s);
  const int substeps = std::max(1, static_cast<int>(std::ceil(step_s / kMaxSubstepS)));
  for (int part = 0; part < substeps; ++part) move_vertically(step_s / substeps, force_n_.z);
}

void MouseDevice::move_vertically(double step_s, double normal_force_n) noexcept {
  const double change = step_s / options_.push_time_s;
  push_share_ = std::clamp(push_share_ + (is_pressed_ ? change : -change), 0.0, 1.0);
  const double push_weight = smooth_step(push_share_);
  const double hover_n = std::clamp(kHoverStiffness_n_per_mm * (options_.hover_mm - height_mm_),
                                    -options_.push_n, options_.push_n);
  const double hand_n = (1.0 - push_weight) * hover_n - push_weight * options_.push_n;
  // Semi-implicit Euler, with a fully implicit damper.
  rise_mm_s_ = (rise_mm_s_ + step_s / kMass * (normal_force_n + hand_n)) /
               (1.0 + step_s / kMass * kDamping_n_s_per_mm);
  const double next_mm = height_mm_ + step_s * rise_mm_s_;
  height_mm_ = std::clamp(next_mm, -kReachMm, kReachMm);
  if (height_mm_ != next_mm) rise_mm_s_ = 0.0;
}

DeviceDriver mouse_driver() {
  return {kMouseDriver,
          "pointer on a screen, for demonstration and pilot sessions: visual, not blind",
          list_mouse, refuse_without_window};
}

}  // namespace touchtrial::device
