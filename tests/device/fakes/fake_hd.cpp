// A stand-in for the vendor's libHD with its real names. It is written from the vendor's public
// text, in our words, and shares no declaration with the driver, so that a slip in either shows.
// Each behaviour names its source: [header]   hdDefines.h and HDDevice.h of OpenHaptics 3.0:
// values, types [guide]    OpenHaptics Toolkit API Reference Guide [sample]   the vendor's sample
// programs: Calibration, AnchoredSpringForce, QueryDevice [notes]    release notes of HDAPI
// [assumed]  no text says so; the strictest that is plausible
#include "device/fakes/fake_hd.hpp"

#include <array>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <thread>
#include <vector>

namespace touchtrial::fakes {
namespace {

using Callback = std::uint32_t (*)(void*);
constexpr std::uint32_t kDevice = 7;
constexpr std::uint32_t kNoDevice = 0xFFFFFFFF;

/// Never destroyed, as the driver keeps the library loaded for ever; goes with a library that is
/// closed all the same.
alignas(FakeHd) std::array<std::byte, sizeof(FakeHd)> room;

/// As the test that loads it orders; the environment orders for a program of its own.
FakeHd* new_state() {
  auto* const made = new (room.data()) FakeHd;
  if (std::getenv("FAKE_HD_NEEDS_RESET") != nullptr) {
    made->calibration_styles = kHdEncoderReset;
    made->calibrated = false;
  }
  return made;
}

FakeHd* state = new_state();

/// The state of the scheduler and the library.
struct Inside {
  CallLog calls;
  std::mutex mutex;  ///< of errors and callbacks; not of anything inside a frame
  std::vector<std::uint32_t> errors;
  std::vector<std::pair<Callback, void*>> callbacks;
  std::thread scheduler;
  Pace pace;
  bool open = false;
  bool force_on = false;
  std::atomic<bool> runs{false};  ///< the scheduler
  bool in_frame = false;          ///< scheduler's thread alone
  Vec3 force_n;                   ///< likewise
};
Inside& inside() {
  static Inside* const kInside = new Inside;
  return *kInside;
}

void note(const char* call) {
  inside().calls.note(call);
}

void push_error(std::uint32_t code) {
  const std::lock_guard lock(inside().mutex);
  inside().errors.push_back(code);
}

void misuse(std::uint32_t code) {
  ++state->misuses;
  push_error(code);
}

void run_callbacks() {
  std::vector<std::pair<Callback, void*>> callbacks;
  {
    const std::lock_guard lock(inside().mutex);
    callbacks = inside().callbacks;
  }
  for (const auto& [callback, data] : callbacks) (void)callback(data);
}

void schedule() {
  while (inside().pace.begin_step()) {
    run_callbacks();
    inside().pace.end_step();
  }
}

void join_scheduler() {
  if (inside().scheduler.joinable()) inside().scheduler.join();
}

unsigned name_bit(const char* name) {
  if (name == nullptr) return kHdNull;
  if (std::strcmp(name, "Default Device") == 0) return kHdDefaultDevice;
  if (std::strcmp(name, "Default PHANToM") == 0) return kHdDefaultPhantom;
  return std::strcmp(name, "Lab Touch") == 0 ? kHdLabTouch : 0U;
}

void copy(Vec3 from, double* to) {
  to[0] = from.x;
  to[1] = from.y;
  to[2] = from.z;
}

void hold_if_asked() {
  while (state->hold_callback) {
    state->callback_held = true;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  state->callback_held = false;
}

bool supports(int style) {
  return (state->calibration_styles & style) != 0;
}

/// Whether the device has what an update by this style takes.
/// Encoder reset: the arm is at a known place, which nothing can check; it may be done before the
/// servo loop runs [sample]. Inkwell: the stylus lies in its fixture, and the servo loop runs
/// [guide, sample]. Auto: new information was gathered while the arm was moved [guide].
bool can_update(int style) {
  if (style == kHdInkwell) return state->in_inkwell && inside().runs;
  return style == kHdEncoderReset || state->has_news;
}

void reset() {
  const std::lock_guard lock(inside().mutex);
  inside().calls.clear();
  inside().errors.clear();
  state->~FakeHd();
  new (state) FakeHd;
}

std::string calls() {
  return inside().calls.text();
}

void give_temperatures(double* values) {
  if (!state->tells_temperature) return push_error(0x100);
  for (std::size_t i = 0; i < 6; ++i) values[i] = state->warmth[i];
}

void give_box(bool tells, Vec3 min_mm, Vec3 max_mm, double* values) {
  if (!tells) return push_error(0x100);
  copy(min_mm, values);
  copy(max_mm, values + 3);
}

}  // namespace
}  // namespace touchtrial::fakes

using namespace touchtrial::fakes;  // NOLINT: what follows is the library's C interface

extern "C" {

/// Tells a bring-up that this is no hardware.
extern const int touchtrial_stand_in;
const int touchtrial_stand_in = 1;

struct FakeErrorInfo {
  std::uint32_t code;
  int internal;
  std::uint32_t device;
};

FakeHdExports* fake_hd_exports() {
  static FakeHdExports exports{state, reset, [](int ticks) { return inside().pace.step(ticks); },
                               [] { inside().pace.run_freely(); }, calls};
  return &exports;
}

std::uint32_t hdInitDevice(const char* name) {
  note("init");
  // [header] HD_INVALID_HANDLE, HD_DEVICE_FAULT; which error it is [assumed]
  if ((name_bit(name) & state->opens_by) == 0) {
    push_error(0x300);
    return kNoDevice;
  }
  // [header] HD_DEVICE_ALREADY_INITIATED
  if (inside().open) {
    misuse(0x301);
    return kNoDevice;
  }
  inside().open = true;
  return kDevice;
}

void hdDisableDevice(std::uint32_t device) {
  note("disable_device");
  join_scheduler();
  if (device != kDevice || !inside().open) misuse(0x104);  // [header] HD_BAD_HANDLE
  inside().open = false;
  inside().force_on = false;
}

void hdMakeCurrentDevice(std::uint32_t device) {
  if (device != kDevice || !inside().open) misuse(0x104);
}

void hdBeginFrame(std::uint32_t device) {
  if (device != kDevice || !inside().open) return misuse(0x400);
  if (inside().in_frame) return misuse(0x402);
  inside().in_frame = true;
  hold_if_asked();
}

void hdEndFrame(std::uint32_t device) {
  if (device != kDevice || !inside().in_frame) return misuse(0x401);
  inside().in_frame = false;
  const touchtrial::Vec3 force_n = inside().force_on ? inside().force_n : touchtrial::Vec3{};
  state->force_n.set(force_n);
  state->zero_forces_last = force_n == touchtrial::Vec3{} ? state->zero_forces_last + 1 : 0;
  state->hand.step(force_n);
  // The force of this frame stays on the hand until another is set [sample: "continue rendering the
  // last force sent" unless zero is sent].
  if (state->lost) push_error(0x302);
  if (const std::uint32_t error = state->next_error.exchange(0); error != 0) push_error(error);
  ++state->frames;
}

void hdEnable(std::uint32_t what) {
  if (what < 0x4000 || what > 0x4002) push_error(0x100);
  if (what == 0x4000) inside().force_on = true;
  note(what == 0x4000 ? "force_on" : what == 0x4001 ? "clamping_on" : "ramping_on");
}

void hdDisable(std::uint32_t what) {
  if (what != 0x4000) misuse(0x100);
  inside().force_on = false;
  note("force_off");
}

void hdGetDoublev(std::uint32_t what, double* values) {
  switch (what) {
    case 0x2050:
      return copy(state->hand.position_mm.get() - state->encoder_error_mm.get(), values);
    case 0x2051:
      return copy(state->hand.velocity.get(), values);
    case 0x2505:
      values[0] = 1.25;
      return;
    case 0x2550:
      return give_box(state->tells_max_workspace, {-210.0, -110.0, -85.0}, {210.0, 205.0, 130.0},
                      values);
    case 0x2551:
      return give_box(state->tells_usable_workspace, {-80.0, -60.0, -40.0}, {80.0, 60.0, 30.0},
                      values);
    // What the maker gives for a Touch: N/mm [sample: "F = k x", N and mm] and N s/mm [assumed], in
    // the precision of a float.
    case 0x2602:
      values[0] = static_cast<double>(0.4F);
      return;
    case 0x2609:  // which the first version of the library did not have [notes]
      if (!state->tells_damping) return push_error(0x100);
      values[0] = static_cast<double>(0.004F);
      return;
    case 0x2603:
      values[0] = 3.25;
      return;
    case 0x2604:
      values[0] = 0.875;
      return;
    case 0x2605:
      return give_temperatures(values);
    default:
      return misuse(0x100);
  }
}

void hdGetIntegerv(std::uint32_t what, int* values) {
  if (what == 0x2000) {
    values[0] = state->buttons;
  } else if (what == 0x2555) {
    values[0] = state->calibration_styles;
  } else {
    misuse(0x100);
  }
}

void hdSetDoublev(std::uint32_t what, const double* values) {
  if (what != 0x2700) return misuse(0x100);
  if (!inside().in_frame) return misuse(0x402);
  inside().force_n = {values[0], values[1], values[2]};
}

const char* hdGetString(std::uint32_t what) {
  if (what == 0x2500) return "3.5.0";
  if (what == 0x2501) return "Touch";
  if (what == 0x2503) return "3D Systems";
  if (what == 0x2504) return "SN-4711";
  push_error(0x100);
  return nullptr;
}

const char* hdGetErrorString(std::uint32_t code) {
  return code == 0x300 ? "no such device" : "fake error";
}

FakeErrorInfo hdGetError() {
  const std::lock_guard lock(inside().mutex);
  if (inside().errors.empty()) return {0, 0, kNoDevice};
  const std::uint32_t code = inside().errors.back();
  inside().errors.pop_back();
  return {code, -1, kDevice};
}

/// Asks for an update as soon as one is possible: when the stylus is put into the inkwell, and,
/// also while everything is calibrated, when a device of the style auto has learnt something
/// [sample: "continually refined as the device is moved"]. Until then a device that is not
/// calibrated waits for a person [header: HD_CALIBRATION_NEEDS_MANUAL_INPUT].
std::uint32_t hdCheckCalibration() {
  const bool learns = supports(kHdAuto) && state->has_news;
  const bool lies = supports(kHdInkwell) && state->in_inkwell && !state->calibrated;
  if (learns || lies) return 0x5001;
  return state->calibrated ? 0x5000 : 0x5002;
}

/// Takes one style that the device supports [header: the values are single bits]; another is an
/// invalid enum, and an update that is not possible a device fault [assumed].
void hdUpdateCalibration(std::uint32_t style) {
  ++state->calibration_updates;
  state->last_style = static_cast<int>(style);
  const bool is_style = style == kHdEncoderReset || style == kHdAuto || style == kHdInkwell;
  if (!is_style || !supports(static_cast<int>(style))) return misuse(0x100);
  if (!can_update(static_cast<int>(style)) || state->failing_updates-- > 0) {
    return push_error(0x300);
  }
  // Wherever the arm is becomes the reset position [sample: "be placed at a known physical location
  // when the reset is commanded"].
  const bool resets = style == kHdEncoderReset;
  state->encoder_error_mm.set(resets ? state->hand.position_mm.get() : touchtrial::Vec3{});
  state->has_news = false;
  state->calibrated = true;
}

void hdStartScheduler() {
  note("start");
  inside().runs = true;
  inside().pace.start();
  inside().scheduler = std::thread(schedule);
}

void hdStopScheduler() {
  note("stop");
  inside().runs = false;
  inside().pace.stop();
  if (!state->lazy_stop) join_scheduler();
}

void hdSetSchedulerRate(unsigned long rate_hz) {
  if (rate_hz != 500 && rate_hz != 1000) push_error(0x101);  // [guide] HD_INVALID_VALUE
}

unsigned long hdScheduleAsynchronous(std::uint32_t (*callback)(void*), void* data,
                                     std::uint16_t /*priority*/) {
  note("schedule");
  const std::lock_guard lock(inside().mutex);
  inside().callbacks.emplace_back(callback, data);
  return 1;
}

#ifdef FAKE_WITH_UNRESOLVED
/// Refers to a function that no library has, as libraries of older systems do.
void touchtrial_no_such_function();
void hdNeverCalled() {
  touchtrial_no_such_function();
}
#endif

#ifndef FAKE_WITHOUT_UNSCHEDULE
void hdUnschedule(unsigned long handle) {
  note("unschedule");
  if (handle != 1) misuse(0x101);
  const std::lock_guard lock(inside().mutex);
  inside().callbacks.clear();
}
#endif

}  // extern "C"
