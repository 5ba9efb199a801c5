// Between the program and Force Dimension's own library, for scripts/judge-dhd, which compiles it.
// It has the functions below in place of the library's and leaves all others to it. It writes what
// the program asks for and what the tip does to the file that JUDGE_LOG names, a line an event.
//
// With JUDGE_ARM it opens the library's simulator of that arm in place of a device, with a hand on
// it. With JUDGE_ARM=falcon, and preloaded, it plugs in the emulated Falcon, with the same hand;
// with JUDGE_HOMED it is homed already.
//
// The simulator exchanges at 4 kHz, knows no weight, and has no time guard: the hand's side of it
// adds the weight that the library carries, and positions are answered by DHD_TIMEGUARD after a
// force, as with a device.
#include "core/vec.hpp"
#include "device/drivers/dhd/judge_falcon.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <numbers>
#include <string>
#include <string_view>
#include <utility>

#include <dlfcn.h>
#include <unistd.h>

namespace {

using touchtrial::Vec3;
using namespace touchtrial::testing;
constexpr int kTimeGuard = 1;
constexpr int kMaxDof = 8;
constexpr int kFalconType = 60;

void* library() {
  static void* const kLibrary = dlopen(std::getenv("JUDGE_LIBRARY"), RTLD_NOW | RTLD_NODELETE);
  return kLibrary;
}

template <typename F>
F* maker(const char* name) {
  return reinterpret_cast<F*>(dlsym(library(), name));
}

double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::FILE* log_file() {
  static std::FILE* const kLog = std::fopen(std::getenv("JUDGE_LOG"), "a");
  return kLog;
}

/// \return JUDGE_ARM
std::string_view arm() {
  const char* const name = std::getenv("JUDGE_ARM");
  return name != nullptr ? name : "";
}
bool is_falcon() {
  return arm() == "falcon";
}
bool is_simulated() {
  return !arm().empty() && !is_falcon();
}

/// Calls that the library makes to itself reach the functions below too.
thread_local int depth = 0;

void note(const char* what, double value, int result) {
  if (depth > 1) return;
  std::fprintf(log_file(), "%.6f %s %g %d\n", now_s(), what, value, result);
}

// --- The library's model of the arm.

using OfAngles = int(double, double, double, double (*)[3], char);
using GravityOf = int(double*, double*, unsigned char, char);

Vec3 cross(Vec3 a, Vec3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// \return what the library adds to a force at these joint angles, N
Vec3 carried_n(const std::array<double, kMaxDof>& angles, char id) {
  std::array<double, kMaxDof> joints = angles;
  std::array<double, kMaxDof> torques{};
  double j[3][3] = {};
  maker<GravityOf>("dhdJointAnglesToGravityJointTorques")(joints.data(), torques.data(), 7, id);
  maker<OfAngles>("dhdDeltaJointAnglesToJacobian")(joints[0], joints[1], joints[2], j, id);
  // The transposed Jacobian times the force is the torques.
  const Vec3 a{j[0][0], j[1][0], j[2][0]};
  const Vec3 b{j[0][1], j[1][1], j[2][1]};
  const Vec3 c{j[0][2], j[1][2], j[2][2]};
  return 1.0 / dot(a, cross(b, c)) *
         (torques[0] * cross(b, c) + torques[1] * cross(c, a) + torques[2] * cross(a, b));
}

// --- The simulator.

/// A hand that strokes the middle of the workspace, and lifts off for a second in every five.
class Hand {
 public:
  /// \param tip_n  the device's force on it, with the weight of the arm
  void move(Vec3 tip_n) {
    const double time_s = now_s() - began_s_;
    const double step_s = std::min(time_s - std::exchange(moved_s_, time_s), 0.02);
    for (double left_s = step_s; left_s > 0.0; left_s -= kStepS) {
      const Vec3 grip_n =
          kStiffnessNPerM * (wanted_m(time_s) - place_m) - kDampingNsPerM * velocity_;
      velocity_ = velocity_ + kStepS / kInertiaKg * (grip_n + tip_n);
      place_m = place_m + kStepS * velocity_;
    }
  }
  [[nodiscard]] bool is_off() const { return is_off_at(now_s() - began_s_); }

  Vec3 place_m{0.0, 0.0, 0.01};

 private:
  static constexpr double kStiffnessNPerM = 1000.0;
  static constexpr double kDampingNsPerM = 28.0;
  static constexpr double kInertiaKg = 0.2;
  static constexpr double kStepS = 0.00025;

  [[nodiscard]] static bool is_off_at(double time_s) { return std::fmod(time_s, 5.0) < 1.0; }
  [[nodiscard]] static Vec3 wanted_m(double time_s) {
    const double turn = 2.0 * std::numbers::pi * time_s;
    const double tremor_m = 0.00003 * std::sin(9.0 * turn);
    const double height_m = is_off_at(time_s) ? 0.01 : -0.003;
    return {0.004 * std::sin(0.3 * turn), 0.008 * std::sin(0.8 * turn), height_m + tremor_m};
  }

  double began_s_ = now_s();
  double moved_s_ = 0.0;
  Vec3 velocity_;
};

/// Everything of the one device that is open.
struct Desk {
  std::recursive_mutex mutex;
  int arm = 0;       ///< type of the simulated arm; 0: a device
  int weigher = -1;  ///< a second simulated arm, whose compensation nobody switches
  void* simulator = nullptr;
  Hand hand;
  bool is_held = false;  ///< a Falcon, whose axes are homed
  /// \name Of the newest force
  ///@{
  double forced_s = 0.0;
  Vec3 asked_n;
  int result = 0;
  bool on = false;
  Vec3 weight_n;
  ///@}
  bool has_read = false;  ///< a position, since then
  // When the newest of these was noted: the log has no more than a line a millisecond.
  double force_noted_s = 0.0;
  double status_noted_s = 0.0;
  double reads_noted_s = 0.0;
  double ours_noted_s = 0.0;
  int reads = 0;  ///< positions since then
  int guarded_reads = 0;
};
Desk& desk() {
  static Desk* const kDesk = new Desk;
  return *kDesk;
}

/// One call of the program's.
class Entry {
 public:
  Entry() : lock_(desk().mutex) { ++depth; }
  ~Entry() { --depth; }
  Entry(const Entry&) = delete;
  Entry& operator=(const Entry&) = delete;

 private:
  std::lock_guard<std::recursive_mutex> lock_;
};

/// Puts the tip where the hand is.
void place_tip(char id) {
  std::array<int, kMaxDof> counts{};
  const Vec3 at = desk().hand.place_m;
  using ToCounts = int(double, double, double, int*, int*, int*, char);
  maker<ToCounts>("dhdDeltaPositionToEncoder")(at.x, at.y, at.z, &counts[0], &counts[1], &counts[2],
                                               id);
  // Unlike dhdPreset, it tells the library the time, so that its compensation comes and goes.
  using SetEncoders = int(void*, int*, unsigned char, double);
  if (auto* const set = maker<SetEncoders>("_ZN3DHD14SimulateSetEncEPihd"); set != nullptr) {
    set(desk().simulator, counts.data(), 7, now_s());
  } else {
    maker<int(int*, unsigned char, char)>("dhdPreset")(counts.data(), 7, id);
  }
}

using TestOpen = int(int, void**, double);
void open_weigher(int arm) {
  auto* const open = maker<TestOpen>("_Z11dhdTestOpeniPPvd");
  void* scales = nullptr;
  if (desk().weigher < 0 && open != nullptr) desk().weigher = open(arm, &scales, 0.0);
}

int open_simulator(bool is_robotic) {
  Desk& all = desk();
  all.arm = std::atoi(std::getenv("JUDGE_ARM"));
  void* device = nullptr;
  void* robot = nullptr;
  using RobotTestOpen = int(int, void**, void**, double, double);
  const auto open = maker<TestOpen>("_Z11dhdTestOpeniPPvd");
  const auto open_robot = maker<RobotTestOpen>("_Z11drdTestOpeniPPvS0_dd");
  const int id = is_robotic && open_robot != nullptr
                     ? open_robot(all.arm, &robot, &device, 0.00025, 0.0)
                     : open(all.arm, &device, 0.00025);
  if (id < 0) return id;
  // The calibration of the simulator.
  std::array<int, kMaxDof> counts{};
  using ToCounts = int(double, double, double, int*, int*, int*, char);
  maker<ToCounts>("dhdDeltaPositionToEncoder")(0.0, 0.0, 0.02, &counts[0], &counts[1], &counts[2],
                                               static_cast<char>(id));
  maker<int(int*, unsigned char, char)>("dhdPreset")(counts.data(), 0xff, static_cast<char>(id));
  all.simulator = device;
  open_weigher(all.arm);
  all.hand = Hand();
  place_tip(static_cast<char>(id));
  return id;
}

/// A line of the newest force.
void note_tip(Vec3 tip_n) {
  Desk& all = desk();
  const double time_s = now_s();
  if (time_s - all.force_noted_s < 0.0009) return;
  all.force_noted_s = time_s;
  std::fprintf(log_file(), "%.6f force %g %g %g %d %d %g %g %g %g %g %d\n", time_s, all.asked_n.x,
               all.asked_n.y, all.asked_n.z, all.result, all.on ? 1 : 0, tip_n.x, tip_n.y, tip_n.z,
               all.weight_n.z, all.hand.place_m.z, all.hand.is_off() ? 1 : 0);
}

/// The firmware's homing over, a hand takes the grip.
void plug_falcon_in() {
  plug_falcon(
      [](Vec3 push_n) {
        Desk& all = desk();
        if (!std::exchange(all.is_held, true)) all.hand = Hand();
        const Vec3 tip_n = push_n - all.weight_n;
        all.hand.move(tip_n);
        note_tip(tip_n);
        return all.hand.place_m;
      },
      std::getenv("JUDGE_HOMED") != nullptr);
}

int open_device(const char* name, char id, bool is_robotic) {
  const Entry entry;
  maker<int()>("dhdEnableExpertMode")();
  const int result = is_simulated() ? open_simulator(is_robotic) : maker<int(char)>(name)(id);
  if (is_falcon()) open_weigher(kFalconType);
  note("open", 0.0, result);
  return result;
}

/// Positions since the line before: guarded ones, and all.
void note_reads() {
  Desk& all = desk();
  note("positions", std::exchange(all.guarded_reads, 0), std::exchange(all.reads, 0));
  all.reads_noted_s = now_s();
}

bool has_force(char id) {
  std::array<int, 32> status{};
  maker<int(int*, char)>("dhdGetStatus")(status.data(), id);
  return status[5] == 1;
}

/// Before and after a device is closed.
void note_force_at_close(char id) {
  note("force_at_close", 0.0, (is_falcon() ? falcon_pushes() : has_force(id)) ? 1 : 0);
}

int close_device(const char* name, char id) {
  note_reads();
  note_force_at_close(id);
  const int result = maker<int(char)>(name)(id);
  note("close", 0.0, result);
  if (is_falcon()) {
    note_force_at_close(id);
    note("firmware", falcon_firmware_bytes(), 0);
    for (std::string complaint : falcon_complaints()) {
      std::ranges::replace(complaint, ' ', '_');
      note(("complaint:" + complaint).c_str(), 0.0, 0);
    }
  }
  std::fflush(log_file());
  return result;
}

/// What our driver falcon would make of the newest force and of the newest encoders.
/// \param whole_n  with the weight that the library added
void note_ours(Vec3 whole_n) {
  if (!is_falcon_homed() || norm(whole_n) < 0.2) return;
  const auto ours = our_falcon(whole_n);
  if (!ours || now_s() - desk().ours_noted_s < 0.01) return;
  desk().ours_noted_s = now_s();
  Vec3 at;
  maker<int(double*, double*, double*, char)>("dhdGetPosition")(&at.x, &at.y, &at.z, 0);
  note("off_emulator_um", 1e6 * norm(at - falcon_position_m()), 0);
  note("off_driver_um", 1e6 * norm(at - ours->position_m), 0);
  note("motor_share", ours->share, static_cast<int>(std::lround(ours->rest)));
}

/// After a force: what the tip does to a hand, the hand's motion, and the line in the log.
void feel(int result, char id) {
  Desk& all = desk();
  std::array<double, kMaxDof> angles{};
  maker<int(double*, char)>("dhdGetJointAngles")(angles.data(), id);
  Vec3 tip_n;
  maker<int(double*, double*, double*, char)>("dhdGetForce")(&tip_n.x, &tip_n.y, &tip_n.z, id);
  const Vec3 carried = carried_n(angles, id);
  // A device's arm has its weight; the simulator's has that of the library's model.
  all.weight_n = all.weigher >= 0 ? carried_n(angles, static_cast<char>(all.weigher)) : carried;
  all.result = result;
  all.on = has_force(id);
  all.forced_s = now_s();
  if (is_falcon()) return note_ours(all.asked_n + carried);
  tip_n = (all.on ? tip_n + carried : Vec3{}) - all.weight_n;
  if (all.arm != 0) {
    // The brakes hold an arm that nobody carries.
    all.hand.move(all.on ? tip_n : Vec3{});
    place_tip(id);
  }
  note_tip(tip_n);
}

int call_noted(const char* name, double value, int result) {
  note(name, value, result);
  return result;
}

}  // namespace

extern "C" {

int dhdGetDeviceCount() {
  if (is_falcon()) plug_falcon_in();
  return is_simulated() ? 1 : maker<int()>("dhdGetDeviceCount")();
}

int dhdOpenID(char id) {
  return open_device("dhdOpenID", id, false);
}

int drdOpenID(char id) {
  return open_device("drdOpenID", id, true);
}

int dhdClose(char id) {
  const Entry entry;
  return close_device("dhdClose", id);
}

int drdClose(char id) {
  const Entry entry;
  return close_device("drdClose", id);
}

int dhdSetForce(double fx, double fy, double fz, char id) {
  const Entry entry;
  if (depth == 1) desk().asked_n = {fx, fy, fz};
  const int result = maker<int(double, double, double, char)>("dhdSetForce")(fx, fy, fz, id);
  desk().has_read = false;
  if (depth == 1) feel(result, id);
  return result;
}

int dhdGetPosition(double* px, double* py, double* pz, char id) {
  const Entry entry;
  Desk& all = desk();
  // What would be an exchange takes its time.
  if (all.arm != 0 && std::exchange(all.has_read, true)) usleep(250);
  int result = maker<int(double*, double*, double*, char)>("dhdGetPosition")(px, py, pz, id);
  const double time_s = now_s();
  if (result == 0 && all.arm != 0 && time_s - all.forced_s < 0.002) result = kTimeGuard;
  if (result < 0) note("position_refused", 0.0, result);
  ++all.reads;
  all.guarded_reads += result == kTimeGuard ? 1 : 0;
  if (time_s - all.reads_noted_s > 0.1) note_reads();
  return result;
}

int dhdGetStatus(int* status, char id) {
  const Entry entry;
  const int result = maker<int(int*, char)>("dhdGetStatus")(status, id);
  if (now_s() - desk().status_noted_s > 0.01) {
    desk().status_noted_s = now_s();
    note(status[3] == 1   ? "status_reset"
         : status[5] == 1 ? "status_force"
                          : "status_off",
         status[14], result);
  }
  return result;
}

int dhdEnableForce(unsigned char on, char id) {
  const Entry entry;
  return call_noted("enable", on, maker<int(unsigned char, char)>("dhdEnableForce")(on, id));
}

int dhdStop(char id) {
  const Entry entry;
  return call_noted("stop", 0.0, maker<int(char)>("dhdStop")(id));
}

int dhdSetGravityCompensation(int on, char id) {
  const Entry entry;
  return call_noted("gravity", on, maker<int(int, char)>("dhdSetGravityCompensation")(on, id));
}

int dhdSetWatchdog(unsigned char units, char id) {
  const Entry entry;
  const int result = maker<int(unsigned char, char)>("dhdSetWatchdog")(units, id);
  unsigned char kept = units;
  if (auto* const get = maker<int(unsigned char*, char)>("dhdGetWatchdog")) get(&kept, id);
  note("watchdog_kept", kept, 0);
  return call_noted("watchdog", units, result);
}

int dhdSetTimeGuard(int us, char id) {
  const Entry entry;
  return call_noted("guard", us, maker<int(int, char)>("dhdSetTimeGuard")(us, id));
}

int dhdSetMaxForce(double max_n, char id) {
  const Entry entry;
  return call_noted("max_force", max_n, maker<int(double, char)>("dhdSetMaxForce")(max_n, id));
}

/// The hand needs the expert's functions all the time.
int dhdDisableExpertMode() {
  return 0;
}

}  // extern "C"
