// A stand-in for the vendor's libdhd (and libdrd) with its real names. It is written from the
// vendor's texts and shares no declaration with the driver, so that a slip in either shows. Each
// behaviour names its source:
//
//   [H]  the vendor's header dhdc.h (3.7): names, numbers, the order of arguments
//   [D]  the vendor's programming manual, as the public Python bindings for 3.14 to 3.16 repeat it
//   [M]  the vendor's user manuals of omega.x, delta.x and sigma.7
//   [S]  the vendor's sample programs
//   [L]  the vendor's library 3.17.5, observed without a device
#include "device/fakes/fake_dhd.hpp"

#include <algorithm>
#include <array>
#include <atomic>

namespace touchtrial::fakes {
namespace {

constexpr int kFailed = -1;  // [D]: "0 on success, -1 otherwise"
constexpr double kMmPerM = 1000.0;
constexpr double kGravityMS2 = 9.80665;
constexpr auto kTimeGuard = std::chrono::milliseconds(2);      // [L]: that of -1
constexpr auto kGravityRamp = std::chrono::milliseconds(250);  // [L]

// [H]: the errors that dhdErrorGetLast tells, of which the driver sees the words alone.
constexpr int kErrorExpertModeDisabled = 9;

// [H]: causes for which force went off.
constexpr int kOffByButton = 1;
constexpr int kOffBySoftware = 4;

// [D] Device Modes: an active device is in one of four modes. RESET: a person is expected to put
// the end-effector at its rest position. IDLE: the position can be read, no current in the motors.
// FORCE: motors are on. BRAKE: force is off, motors brake; entered when force is disabled or a
// safety feature acts.
enum class Mode { reset, idle, force, brake };

FakeDhd* state = new FakeDhd;  // never freed: the driver keeps the library loaded for ever

struct Inside {
  CallLog calls;
  Pace pace;
  std::atomic<int> open{-1};  ///< the open device
  std::atomic<bool> force_on{false};
  std::atomic<bool> expert{false};
  std::atomic<int> last_error{0};
  std::atomic<long> forces{0};
  std::atomic<long> gravity_off_at{0};  ///< number of the force
  Vec3 read_mm;                         ///< by the last exchange, on the driver's thread
  long read_at = -1'000'000;            ///< number of the force
};
Inside& inside() {
  static Inside* const kInside = new Inside;
  return *kInside;
}

void note(const char* call) {
  inside().calls.note(call);
}

int fail(int error) {
  inside().last_error = error;
  return kFailed;
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

// [D] Expert Mode: low-level functions must be enabled first. [H] lists which they are.
bool is_expert() {
#ifdef FAKE_OF_OLD
  return true;
#else
  return inside().expert;
#endif
}

Mode mode() {
  if (!state->calibrated) return Mode::reset;
  if (inside().force_on) return Mode::force;
  return state->brakes ? Mode::brake : Mode::idle;
}

double mass_kg() {
  return state->effector_mass_kg >= 0.0 ? state->effector_mass_kg : state->own_mass_kg;
}

/// What the library believes that arms and end-effector weigh.
double modelled_weight_n() {
  return kGravityMS2 * (state->arm_mass_kg + mass_kg());
}

// [L]: force and torques of the compensation fade within 250 ms after it was switched off, though
// the status says so at once.
double gravity_share() {
  if (state->gravity_compensation != 0) return 1.0;
  const std::chrono::milliseconds gone(inside().forces - inside().gravity_off_at);
  return std::max(0.0, 1.0 - static_cast<double>(gone.count()) / kGravityRamp.count());
}

/// What they do weigh.
double true_weight_n() {
  return kGravityMS2 * (state->arm_mass_kg + state->own_mass_kg);
}

void force_off(int cause) {
  if (inside().force_on) state->force_off_cause = cause;
  inside().force_on = false;
  state->brakes = true;
  state->force_n.set({});
}

// [M] omega: force can be switched on and off at any time by the force button.
void press_force_button() {
  if (inside().force_on) {
    force_off(kOffByButton);
  } else {
    inside().force_on = true;
    state->brakes = false;
  }
}

std::chrono::nanoseconds now() {
  return std::chrono::milliseconds(inside().forces.load());
}

/// Takes the position from the device.
void exchange() {
  inside().read_mm = state->hand.position_mm.get();
  inside().read_at = inside().forces;
}

void reset() {
  inside().calls.clear();
  inside().force_on = false;
  inside().read_at = -1'000'000;
  inside().gravity_off_at = -1'000'000;
  state->~FakeDhd();
  new (state) FakeDhd;
}

std::string calls() {
  return inside().calls.text();
}

Vec3 within_max_force(Vec3 force_n) {
  const double max_n = state->max_force_n;
  const double norm_n = norm(force_n);
  return max_n >= 0.0 && norm_n > max_n ? (max_n / norm_n) * force_n : force_n;
}

void give_m(Vec3 mm, double* x, double* y, double* z) {
  *x = mm.x / kMmPerM;
  *y = mm.y / kMmPerM;
  *z = mm.z / kMmPerM;
}

#ifndef FAKE_OF_OLD
/// Joints of a delta whose Jacobian is the same everywhere, m/rad; rows are x, y and z.
constexpr double kJacobian[3][3] = {{0.05, -0.02, -0.03}, {0.0, 0.04, -0.05}, {0.06, 0.07, 0.05}};
constexpr std::array<double, 3> kAngles = {0.3, -0.1, 0.2};

// [S] "torques": the torques of a force are the transposed Jacobian times the force, and those of
// the gravity compensation are added to them.
void give_gravity_torques(double* torques) {
  const Vec3 force_n =
      gravity_share() *
      (state->weight_is_nonsense ? Vec3{5.0, 0.0, -3.0} : Vec3{0.0, 0.0, modelled_weight_n()});
  for (int j = 0; j < 3; ++j) {
    torques[j] =
        kJacobian[0][j] * force_n.x + kJacobian[1][j] * force_n.y + kJacobian[2][j] * force_n.z;
  }
}

bool are_arm_angles(double a, double b, double c) {
  const bool known = a == kAngles[0] && b == kAngles[1] && c == kAngles[2];
  if (!known) ++state->misuses;
  return known;
}
#endif

int open_device(char index) {
  note("open");
  // [D] openID: the index is below the number of connected devices.
  if (!state->opens || index < 0 || index >= state->devices) return kFailed;
  if (inside().open >= 0) ++state->misuses;
  inside().open = index;
  // [M]: when a connection is made, force is disabled; the brakes are on while force is off.
  inside().force_on = false;
  state->brakes = true;
  return index;
}

int close_device(char device) {
  note("close");
  if (!is_open(device)) return kFailed;
  inside().open = -1;
  return 0;
}

}  // namespace
}  // namespace touchtrial::fakes

using namespace touchtrial::fakes;  // NOLINT: what follows is the library's C interface

extern "C" {

/// Tells a bring-up that this is no hardware.
extern const int touchtrial_stand_in;
const int touchtrial_stand_in = 1;

FakeDhdExports* fake_dhd_exports() {
  static FakeDhdExports exports{state,
                                reset,
                                [](int ticks) { return inside().pace.step(ticks); },
                                [] { inside().pace.run_freely(); },
                                calls,
                                force_off,
                                press_force_button,
                                now};
  return &exports;
}

// [D]: all that are connected, also those that other programs hold.
int dhdGetDeviceCount() {
  return state->devices;
}

int dhdOpenID(char index) {
  return open_device(index);
}

int dhdClose(char device) {
  return close_device(device);
}

// [D] Axes: x towards the person, y to the right, z up, metres. [M] has the same in its figures.
// [D] TimeGuard: returns 1 if communication was unnecessary. [L]: the values are those of the last
// exchange, and a force is an exchange, so that they are fresh.
int dhdGetPosition(double* x, double* y, double* z, char device) {
  if (!inside().pace.begin_step()) return kFailed;
  ++state->polls;
  if (!answers(device) || state->position_fails) return kFailed;
  const std::chrono::milliseconds age(inside().forces - inside().read_at);
  const bool is_guarded = state->time_guard_us != 0 && age < kTimeGuard;
  if (state->exchanges && !is_guarded) exchange();
  give_m(inside().read_mm, x, y, z);
  return is_guarded || !state->exchanges ? 1 : 0;
}

// [D] Gravity Compensation: computed on the host, so it only acts whenever a force is sent; the
// weights of arms and end-effector are taken into account, and a vertical force is added to the
// user's command. It is on by default.
// [D] setMaxForce: a limit to the magnitude of what setForce applies; negative: none. [L]: of what
// it is given, before the weight is added; `limits_sum` is another reading of [D].
int dhdSetForce(double x, double y, double z, char device) {
  const touchtrial::Vec3 asked_n{x, y, z};
  touchtrial::Vec3 force_n;
  if (mode() == Mode::force) {
    const touchtrial::Vec3 weight_n{0.0, 0.0, gravity_share() * modelled_weight_n()};
    force_n = state->limits_sum ? within_max_force(asked_n + weight_n)
                                : within_max_force(asked_n) + weight_n;
  }
  state->force_n.set(force_n);
  state->zero_forces_last = asked_n == touchtrial::Vec3{} ? state->zero_forces_last + 1 : 0;
  if (state->exchanges) exchange();
  state->hand.step(force_n - touchtrial::Vec3{0.0, 0.0, true_weight_n()});
  ++inside().forces;
  inside().pace.end_step();
  if (!answers(device)) return kFailed;
  if (!state->exchanges) return 1;
  // [D]: 2 if a motor cannot give what was asked for.
  return state->saturated ? 2 : 0;
}

#ifndef FAKE_WITHOUT_ENABLE_FORCE
// [D] enableForce: switches the controller's force mode on or off. [D] Device Modes: BRAKE is
// entered when force is disabled. In RESET there is no other mode. [M] omega: a person may have to
// press the force button.
int dhdEnableForce(unsigned char on, char device) {
  note(on != 0 ? "force_on" : "force_off");
  if (!is_open(device)) return kFailed;
  if (on == 0) {
    force_off(kOffBySoftware);
  } else if (state->calibrated && !state->wants_button) {
    inside().force_on = true;
    state->brakes = false;
  }
  return 0;
}
#endif

#ifndef FAKE_OF_OLD
// [D] stop: disables force and puts the device into BRAKE mode.
int dhdStop(char device) {
  note("stop");
  if (!answers(device)) return kFailed;
  force_off(kOffBySoftware);
  return 0;
}
#endif

unsigned dhdGetButtonMask(char device) {
  return answers(device) ? state->buttons.load() : 0;
}

// [H] the places of the status, 16 or 17 of them; [D] Device Modes: exactly one of RESET, IDLE,
// FORCE and BRAKE. [D] ForceOffCause: the event that disabled force the last time, however long
// ago.
int dhdGetStatus(int* status, char device) {
  if (!is_open(device)) return kFailed;
  for (int i = 0; i < 17; ++i) status[i] = 0;
  const Mode now_in = mode();
  status[0] = 1;
  status[1] = state->connected ? 1 : 0;
  status[2] = 1;
  status[3] = now_in == Mode::reset ? 1 : 0;
  status[4] = now_in == Mode::idle ? 1 : 0;
  status[5] = now_in == Mode::force ? 1 : 0;
  status[6] = now_in == Mode::brake ? 1 : 0;
  status[9] = state->device_error ? 1 : 0;
  status[10] = state->gravity_compensation;
  status[11] = state->time_guard_us != 0 ? 1 : 0;
  status[14] = state->force_off_cause;
  return 0;
}

int dhdSetTimeGuard(int us, char device) {
  if (!is_open(device)) return kFailed;
  if (!is_expert()) return fail(kErrorExpertModeDisabled);
  state->time_guard_us = us;
  return 0;
}

int dhdSetGravityCompensation(int on, char device) {
  if (!is_open(device)) return kFailed;
  if (state->gravity_compensation != 0 && on == 0) inside().gravity_off_at = inside().forces.load();
  state->gravity_compensation = on;
  return 0;
}

// [D] setEffectorMass: kg, needed where the end-effector is not the maker's own.
int dhdSetEffectorMass(double kg, char device) {
  if (!is_open(device) || state->refuses_mass) return kFailed;
  state->effector_mass_kg = kg;
  return 0;
}

const char* dhdErrorGetLastStr() {
  return "fake words";
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

// [D] getEffectorMass: the mass that is defined now.
int dhdGetEffectorMass(double* kg, char device) {
  *kg = mass_kg();
  return is_open(device) ? 0 : kFailed;
}

int dhdSetMaxForce(double limit_n, char device) {
  if (!is_open(device)) return kFailed;
  state->max_force_n = limit_n;
  return 0;
}

int dhdSetWatchdog(unsigned char times_125_us, char device) {
  if (!is_open(device)) return kFailed;
  if (!is_expert()) return fail(kErrorExpertModeDisabled);
  state->watchdog = times_125_us;
  return 0;
}

int dhdGetWatchdog(unsigned char* times_125_us, char device) {
  if (!is_open(device)) return kFailed;
  if (!is_expert()) return fail(kErrorExpertModeDisabled);
  *times_125_us = static_cast<unsigned char>(state->watchdog);
  return 0;
}

int dhdGetSystemType(char device) {
  return is_open(device) ? state->system_type.load() : kFailed;
}

const char* dhdGetSystemName(char device) {
  return is_open(device) ? "omega.3" : nullptr;
}

int dhdGetSerialNumber(unsigned short* serial, char device) {
  *serial = 4242;
  return is_open(device) ? 0 : kFailed;
}

int dhdGetVersion(double* version, char device) {
  *version = 3.5;
  return is_open(device) ? 0 : kFailed;
}

void dhdGetSDKVersion(int* major, int* minor, int* release, int* revision) {
  *major = 3;
  *minor = 17;
  *release = 5;
  *revision = 1900;
}

int dhdGetDeltaJointAngles(double* a, double* b, double* c, char device) {
  if (!is_expert()) return fail(kErrorExpertModeDisabled);
  *a = kAngles[0];
  *b = kAngles[1];
  *c = kAngles[2];
  return answers(device) ? 0 : kFailed;
}

// [D]: the torques that compensate gravity at these angles.
int dhdDeltaGravityJointTorques(double a, double b, double c, double* t0, double* t1, double* t2,
                                char device) {
  if (!is_expert()) return fail(kErrorExpertModeDisabled);
  if (!is_open(device) || !are_arm_angles(a, b, c)) return kFailed;
  std::array<double, 3> torques{};
  give_gravity_torques(torques.data());
  *t0 = torques[0];
  *t1 = torques[1];
  *t2 = torques[2];
  return 0;
}

int dhdDeltaJointAnglesToJacobian(double a, double b, double c, double jacobian[3][3],
                                  char device) {
  if (!is_expert()) return fail(kErrorExpertModeDisabled);
  if (!is_open(device) || !are_arm_angles(a, b, c)) return kFailed;
  for (int i = 0; i < 3; ++i) std::copy_n(kJacobian[i], 3, jacobian[i]);
  return 0;
}
#endif

#ifdef FAKE_WITH_DRD
// libdrd has libdhd's functions as well, and devices opened by either are the same.

// [D]: "Open a connection to one particular device".
int drdOpenID(char index) {
  note("drd");
  return open_device(index);
}

int drdClose(char device) {
  note("drd");
  return close_device(device);
}

// [D] isInitialized: reflects the status of the controller's RESET light.
bool drdIsInitialized(char device) {
  return is_open(device) && state->calibrated;
}

// [D] autoInit: moves the device to a known position and resets its encoders there.
int drdAutoInit(char device) {
  note("auto_init");
  if (!answers(device) || state->auto_init_fails) return kFailed;
  state->calibrated = true;
  return 0;
}

// The functions of 3.16, which replace those for the arms alone.
int dhdGetJointAngles(double* angles, char device) {
  if (!is_expert()) return fail(kErrorExpertModeDisabled);
  std::fill_n(angles, 8, 0.0);
  std::copy(kAngles.begin(), kAngles.end(), angles);
  return answers(device) ? 0 : kFailed;
}

int dhdJointAnglesToGravityJointTorques(double* angles, double* torques, unsigned char mask,
                                        char device) {
  if (!is_expert()) return fail(kErrorExpertModeDisabled);
  if (!is_open(device) || mask != 0xff || !are_arm_angles(angles[0], angles[1], angles[2])) {
    return kFailed;
  }
  std::fill_n(torques, 8, 0.0);
  give_gravity_torques(torques);
  return 0;
}
#endif

}  // extern "C"
