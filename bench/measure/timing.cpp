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

std::vector<TimeBeside> time_in_turns(const Cases& cases, const Effort& effort) {
  std::vector<Side> sides;
  double round_us = 0.0;
  for (const Case& one : cases) {
    sides.emplace_back(one);
    round_us += sides.back().turn_us();
  }
  std::vector<std::vector<double>> times_us(cases.size());
  std::vector<std::vector<double>> ratios(cases.size());
  const int rounds = rounds_for(round_us, effort);
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < sides.size(); ++i) {
      times_us[i].push_back(sides[i].turn());
      ratios[i].push_back(times_us[0].back() / times_us[i].back());
    }
  }
  std::vector<TimeBeside> times;
  for (std::size_t i = 0; i < sides.size(); ++i) {
    times.push_back({median(times_us[i]), median(ratios[i])});
  }
  return times;
}

}  // namespace touchtrial::bench
