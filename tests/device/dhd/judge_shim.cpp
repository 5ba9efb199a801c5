// Between the program and Force Dimension's own library, for scripts/judge-dhd, which compiles it.
// It has the functions below in place of the library's and leaves all others to it. It writes what
// the program asks for and what the tip does to the file that JUDGE_LOG names, a line an event,
// and, with JUDGE_ARM, opens the library's simulator of that arm in place of a device, with a hand
// on it.
//
// The simulator exchanges at 4 kHz, knows no weight, and has no time guard: the hand's side of it
// adds the weight that the library carries, and positions are answered by DHD_TIMEGUARD after a
// force, as with a device.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <numbers>
#include <utility>

#include <dlfcn.h>
#include <unistd.h>

namespace {

using Vec = std::array<double, 3>;
constexpr int kTimeGuard = 1;
constexpr int kMostDof = 8;

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

/// Calls that the library makes to itself reach the functions below too.
thread_local int depth = 0;

void note(const char* what, double value, int result) {
  if (depth > 1) return;
  std::fprintf(log_file(), "%.6f %s %g %d\n", now_s(), what, value, result);
}

// --- The library's model of the arm.

using OfAngles = int(double, double, double, double (*)[3], char);
using GravityOf = int(double*, double*, unsigned char, char);

/// \return what the library adds to a force at these joint angles, N
Vec carried_n(const std::array<double, kMostDof>& angles, char id) {
  std::array<double, kMostDof> joints = angles;
  std::array<double, kMostDof> torques{};
  double j[3][3] = {};
  maker<GravityOf>("dhdJointAnglesToGravityJointTorques")(joints.data(), torques.data(), 7, id);
  maker<OfAngles>("dhdDeltaJointAnglesToJacobian")(joints[0], joints[1], joints[2], j, id);
  // The transposed Jacobian times the force is the torques.
  const auto minor = [&](int a, int b, int c, int d) {
    return j[a][b] * j[c][d] - j[a][d] * j[c][b];
  };
  const double whole =
      j[0][0] * minor(1, 1, 2, 2) - j[0][1] * minor(1, 0, 2, 2) + j[0][2] * minor(1, 0, 2, 1);
  Vec force{};
  for (int row = 0; row < 3; ++row) {
    const int next = (row + 1) % 3;
    const int last = (row + 2) % 3;
    for (int arm = 0; arm < 3; ++arm) {
      const int second = (arm + 1) % 3;
      const int third = (arm + 2) % 3;
      force.at(row) += minor(next, second, last, third) / whole * torques.at(arm);
    }
  }
  return force;
}

// --- The simulator.

/// A hand that strokes the middle of the workspace, and lifts off for a second in every five.
class Hand {
 public:
  /// \param tip_n  the device's force on it
  void move(const Vec& tip_n, double time_s, double step_s) {
    for (double left_s = std::min(step_s, 0.02); left_s > 0.0; left_s -= kStepS) {
      const Vec wanted = wanted_m(time_s);
      for (std::size_t i = 0; i < 3; ++i) {
        const double grip_n =
            kStiffnessNPerM * (wanted.at(i) - place_m.at(i)) - kDampingNsPerM * velocity_.at(i);
        velocity_.at(i) += kStepS / kInertiaKg * (grip_n + tip_n.at(i));
        place_m.at(i) += kStepS * velocity_.at(i);
      }
    }
  }
  [[nodiscard]] static bool is_off(double time_s) { return std::fmod(time_s, 5.0) < 1.0; }

  Vec place_m{0.0, 0.0, 0.02};

 private:
  static constexpr double kStiffnessNPerM = 1000.0;
  static constexpr double kDampingNsPerM = 28.0;
  static constexpr double kInertiaKg = 0.2;
  static constexpr double kStepS = 0.00025;

  [[nodiscard]] static Vec wanted_m(double time_s) {
    const double turn = 2.0 * std::numbers::pi * time_s;
    const double tremor_m = 0.00003 * std::sin(9.0 * turn);
    const double height_m = is_off(time_s) ? 0.02 : -0.003;
    return {0.004 * std::sin(0.3 * turn), 0.008 * std::sin(0.8 * turn), height_m + tremor_m};
  }

  Vec velocity_{};
};

/// Everything of the one device that is open.
struct Desk {
  std::recursive_mutex mutex;
  int arm = 0;       ///< type of the simulated arm; 0: a device
  int weigher = -1;  ///< a second simulated arm, whose compensation nobody switches
  void* simulator = nullptr;
  Hand hand;
  double began_s = 0.0;
  double forced_s = 0.0;  ///< when the newest force was sent
  bool has_read = false;  ///< a position, since then
  // When the newest of these was noted: the log has no more than a line a millisecond.
  double force_noted_s = 0.0;
  double status_noted_s = 0.0;
  double reads_noted_s = 0.0;
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

bool is_simulated() {
  return std::getenv("JUDGE_ARM") != nullptr;
}

/// Puts the tip where the hand is.
void place_tip(char id) {
  std::array<int, kMostDof> counts{};
  const Vec& at = desk().hand.place_m;
  using ToCounts = int(double, double, double, int*, int*, int*, char);
  maker<ToCounts>("dhdDeltaPositionToEncoder")(at[0], at[1], at[2], &counts[0], &counts[1],
                                               &counts[2], id);
  // Unlike dhdPreset, it tells the library the time, so that its compensation comes and goes.
  using SetEncoders = int(void*, int*, unsigned char, double);
  if (auto* const set = maker<SetEncoders>("_ZN3DHD14SimulateSetEncEPihd"); set != nullptr) {
    set(desk().simulator, counts.data(), 7, now_s());
  } else {
    maker<int(int*, unsigned char, char)>("dhdPreset")(counts.data(), 7, id);
  }
}

int open_simulator(bool is_robotic) {
  Desk& all = desk();
  all.arm = std::atoi(std::getenv("JUDGE_ARM"));
  void* device = nullptr;
  void* robot = nullptr;
  using TestOpen = int(int, void**, double);
  using RobotTestOpen = int(int, void**, void**, double, double);
  const auto open = maker<TestOpen>("_Z11dhdTestOpeniPPvd");
  const auto open_robot = maker<RobotTestOpen>("_Z11drdTestOpeniPPvS0_dd");
  const int id = is_robotic && open_robot != nullptr
                     ? open_robot(all.arm, &robot, &device, 0.00025, 0.0)
                     : open(all.arm, &device, 0.00025);
  if (id < 0) return id;
  maker<int()>("dhdEnableExpertMode")();
  // The calibration of the simulator.
  std::array<int, kMostDof> counts{};
  using ToCounts = int(double, double, double, int*, int*, int*, char);
  maker<ToCounts>("dhdDeltaPositionToEncoder")(0.0, 0.0, 0.02, &counts[0], &counts[1], &counts[2],
                                               static_cast<char>(id));
  maker<int(int*, unsigned char, char)>("dhdPreset")(counts.data(), 0xff, static_cast<char>(id));
  all.simulator = device;
  if (all.weigher < 0) {
    void* scales = nullptr;
    all.weigher = open(all.arm, &scales, 0.0);
  }
  all.hand = Hand();
  all.began_s = now_s();
  place_tip(static_cast<char>(id));
  return id;
}

int open_device(const char* name, char id, bool is_robotic) {
  const Entry entry;
  const int result = is_simulated() ? open_simulator(is_robotic) : maker<int(char)>(name)(id);
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

/// After a force: what the tip does to a hand, the hand's motion, and the line in the log.
void feel(const Vec& asked_n, int result, char id) {
  Desk& all = desk();
  const double time_s = now_s();
  std::array<double, kMostDof> angles{};
  maker<int(double*, char)>("dhdGetJointAngles")(angles.data(), id);
  Vec tip_n{};
  maker<int(double*, double*, double*, char)>("dhdGetForce")(&tip_n[0], &tip_n[1], &tip_n[2], id);
  const Vec carried = carried_n(angles, id);
  // A device's arm has its weight; the simulator's has that of the library's model.
  const Vec weight = all.weigher >= 0 ? carried_n(angles, static_cast<char>(all.weigher)) : carried;
  const bool on = has_force(id);
  for (std::size_t i = 0; i < 3; ++i) {
    tip_n.at(i) = (on ? tip_n.at(i) + carried.at(i) : 0.0) - weight.at(i);
  }
  if (all.arm != 0) {
    const double step_s = all.forced_s > 0.0 ? time_s - all.forced_s : 0.0;
    // The brakes hold an arm that nobody carries.
    all.hand.move(on ? tip_n : Vec{}, time_s - all.began_s, step_s);
    place_tip(id);
  }
  all.forced_s = time_s;
  if (time_s - all.force_noted_s < 0.0009) return;
  all.force_noted_s = time_s;
  std::fprintf(log_file(), "%.6f force %g %g %g %d %d %g %g %g %g %g %d\n", time_s, asked_n[0],
               asked_n[1], asked_n[2], result, on ? 1 : 0, tip_n[0], tip_n[1], tip_n[2], weight[2],
               all.hand.place_m[2], Hand::is_off(time_s - all.began_s) ? 1 : 0);
}

int call_noted(const char* name, double value, int result) {
  note(name, value, result);
  return result;
}

}  // namespace

extern "C" {

int dhdGetDeviceCount() {
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
  note_reads();
  note("force_at_close", 0.0, has_force(id) ? 1 : 0);
  const int result = maker<int(char)>("dhdClose")(id);
  note("close", 0.0, result);
  std::fflush(log_file());
  return result;
}

int drdClose(char id) {
  const Entry entry;
  note_reads();
  note("force_at_close", 0.0, has_force(id) ? 1 : 0);
  const int result = maker<int(char)>("drdClose")(id);
  note("close", 0.0, result);
  std::fflush(log_file());
  return result;
}

int dhdSetForce(double fx, double fy, double fz, char id) {
  const Entry entry;
  const int result = maker<int(double, double, double, char)>("dhdSetForce")(fx, fy, fz, id);
  desk().has_read = false;
  if (depth == 1) feel({fx, fy, fz}, result, id);
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
  return call_noted("watchdog", units,
                    maker<int(unsigned char, char)>("dhdSetWatchdog")(units, id));
}

int dhdSetTimeGuard(int us, char id) {
  const Entry entry;
  return call_noted("guard", us, maker<int(int, char)>("dhdSetTimeGuard")(us, id));
}

int dhdSetMaxForce(double most_n, char id) {
  const Entry entry;
  return call_noted("max_force", most_n, maker<int(double, char)>("dhdSetMaxForce")(most_n, id));
}

/// The simulated hand needs the expert's functions all the time.
int dhdDisableExpertMode() {
  return is_simulated() ? 0 : maker<int()>("dhdDisableExpertMode")();
}

}  // extern "C"
