#include "bench/measure/timing.hpp"

#include "bench/measure/simd_target.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <vector>

namespace touchtrial::bench {
namespace {

constexpr double kTurn_us = 4000.0;

/// One side of a pair.
class Side {
 public:
  explicit Side(const Case& one) : target_(one.target), job_(one.make()) {
    const ForcedTarget forced(target_);
    const double first_us =
        time_us(1);  // includes the cost of memory that is touched for the first time
    const double second_us = first_us > 100.0 * kTurn_us ? first_us : time_us(1);
    runs_ = static_cast<int>(std::clamp(kTurn_us / std::max(second_us, 1e-2), 1.0, 1e6));
    turn_us_ = second_us * (runs_ + (runs_ > 1 ? 1 : 0));
  }

  /// Microseconds of one operation.
  [[nodiscard]] double turn() {
    const ForcedTarget forced(target_);
    if (runs_ > 1) job_.run();
    return time_us(runs_) / runs_ / job_.operations;
  }

  /// The approximate time of a turn.
  [[nodiscard]] double turn_us() const noexcept { return turn_us_; }

 private:
  [[nodiscard]] double time_us(int runs) {
    const double start_us = cpu_clock_us();
    for (int i = 0; i < runs; ++i) job_.run();
    return cpu_clock_us() - start_us;
  }

  std::string target_;
  Job job_;
  int runs_ = 1;
  double turn_us_ = 0.0;
};

int rounds_for(double round_us, const Effort& effort) {
  const double rounds = std::floor(effort.pair_s * 1e6 / round_us);
  return static_cast<int>(std::clamp(rounds, static_cast<double>(effort.least_rounds),
                                     static_cast<double>(effort.most_rounds)));
}

}  // namespace

double cpu_clock_us() noexcept {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return 1e6 * static_cast<double>(now.tv_sec) + 1e-3 * static_cast<double>(now.tv_nsec);
}

PairTimes time_pair(const Case& ours, const Case& peer, const Effort& effort) {
  Side our_side(ours);
  Side peer_side(peer);
  std::vector<double> ours_us, peer_us, ratios;
  const int rounds = rounds_for(our_side.turn_us() + peer_side.turn_us(), effort);
  for (int round = 0; round < rounds; ++round) {
    ours_us.push_back(our_side.turn());
    peer_us.push_back(peer_side.turn());
    ratios.push_back(ours_us.back() / peer_us.back());
  }
  return {median(ours_us), median(peer_us), median(ratios)};
}

PairTimes time_alone(const Case& ours, const Effort& effort) {
  Side side(ours);
  std::vector<double> times_us;
  const int rounds = rounds_for(side.turn_us(), effort);
  for (int round = 0; round < rounds; ++round) times_us.push_back(side.turn());
  return {median(times_us), kNotTaken, kNotTaken};
}

}  // namespace touchtrial::bench
