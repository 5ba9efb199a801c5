// A stand-in for the vendor's libdhd with its real names. It is written from the same facts as the
// driver but shares no declaration with it, so that a slip in either shows.
#include "device/fakes/fake_dhd.hpp"

#include <atomic>

namespace touchtrial::fakes {
namespace {

constexpr int kFailed = -1;
constexpr double kMmPerM = 1000.0;

FakeDhd* state = new FakeDhd;  // never freed: the driver keeps the library loaded for ever

struct Inside {
  CallLog calls;
  Pace pace;
  std::atomic<int> open{-1};  ///< the open device
  std::atomic<bool> force_on{false};
  std::atomic<bool> expert{false};
};
Inside& inside() {
  static Inside* const kInside = new Inside;
  return *kInside;
}

void note(const char* call) {
  inside().calls.note(call);
}

/// \return whether this is the open device; another one is an error of the driver
bool is_open(char device) {
  if (device >= 0 && inside().open == device) return true;
  ++state->misuses;
  return false;
}

bool answers(char device) {
  return is_open(device) && state->connected;
}

void reset() {
  inside().calls.clear();
  state->~FakeDhd();
  new (state) FakeDhd;
}

std::string calls() {
  return inside().calls.text();
}

void give_m(Vec3 mm, double* x, double* y, double* z) {
  *x = mm.x / kMmPerM;
  *y = mm.y / kMmPerM;
  *z = mm.z / kMmPerM;
}

}  // namespace
}  // namespace touchtrial::fakes

using namespace touchtrial::fakes;  // NOLINT: what follows is the library's C interface

extern "C" {

FakeDhdExports* fake_dhd_exports() {
  static FakeDhdExports exports{state, reset, [](int ticks) { return inside().pace.step(ticks); },
                                [] { inside().pace.run_freely(); }, calls};
  return &exports;
}

int dhdGetDeviceCount() {
  return state->devices;
}

int dhdOpenID(char index) {
  note("open");
  if (!state->opens || index < 0 || index >= state->devices) return kFailed;
  if (inside().open >= 0) ++state->misuses;
  inside().open = index;
  return index;
}

int dhdClose(char device) {
  note("close");
  if (!is_open(device)) return kFailed;
  inside().open = -1;
  return 0;
}

int dhdGetPosition(double* x, double* y, double* z, char device) {
  if (!inside().pace.begin_step()) return kFailed;
  ++state->polls;
  if (!answers(device) || state->position_fails) return kFailed;
  give_m(state->hand.position_mm.get(), x, y, z);
  return state->too_soon ? 1 : 0;
}

int dhdGetLinearVelocity(double* x, double* y, double* z, char device) {
  if (!answers(device)) return kFailed;
  give_m(state->hand.velocity.get(), x, y, z);
  return 0;
}

int dhdSetForce(double x, double y, double z, char device) {
  const touchtrial::Vec3 asked_n{x, y, z};
  const touchtrial::Vec3 force_n = inside().force_on ? asked_n : touchtrial::Vec3{};
  state->force_n.set(force_n);
  state->zero_forces_last = asked_n == touchtrial::Vec3{} ? state->zero_forces_last + 1 : 0;
  state->hand.step(force_n);
  inside().pace.end_step();
  if (!answers(device)) return kFailed;
  return state->saturated ? 2 : 0;
}

#ifndef FAKE_WITHOUT_ENABLE_FORCE
int dhdEnableForce(unsigned char on, char device) {
  note(on != 0 ? "force_on" : "force_off");
  if (!is_open(device)) return kFailed;
  inside().force_on = on != 0;
  return 0;
}
#endif

unsigned dhdGetButtonMask(char device) {
  return answers(device) ? state->buttons.load() : 0;
}

int dhdGetStatus(int* status, char device) {
  if (!is_open(device)) return kFailed;
  for (int i = 0; i < 17; ++i) status[i] = 0;
  status[0] = 1;
  status[1] = state->connected ? 1 : 0;
  status[2] = 1;
  status[3] = state->calibrated ? 1 : 0;
  status[5] = inside().force_on && state->force_off_cause == 0 ? 1 : 0;
  status[9] = state->device_error ? 1 : 0;
  status[14] = state->force_off_cause;
  return 0;
}

#ifndef FAKE_OF_OLD
int dhdEnableExpertMode() {
  inside().expert = true;
  return 0;
}

int dhdDisableExpertMode() {
  inside().expert = false;
  return 0;
}
#endif

int dhdSetTimeGuard(int us, char device) {
#ifndef FAKE_OF_OLD
  if (!inside().expert) return kFailed;
#endif
  if (!is_open(device)) return kFailed;
  state->time_guard_us = us;
  return 0;
}

int dhdSetGravityCompensation(int on, char device) {
  if (!is_open(device)) return kFailed;
  state->gravity_compensation = on;
  return 0;
}

int dhdSetEffectorMass(double kg, char device) {
  if (!is_open(device) || state->refuses_mass) return kFailed;
  state->effector_mass_kg = kg;
  return 0;
}

const char* dhdErrorGetLastStr() {
  return "fake words";
}

#ifndef FAKE_OF_OLD
const char* dhdGetSystemName(char device) {
  return is_open(device) ? "omega.3" : nullptr;
}

int dhdGetSerialNumber(unsigned short* serial, char device) {
  *serial = 4242;
  return is_open(device) ? 0 : kFailed;
}

int dhdGetVersion(double* version, char device) {
  *version = 2.5;
  return is_open(device) ? 0 : kFailed;
}
#endif

}  // extern "C"
