#include "protocols/session/simulated_exploration.hpp"

namespace touchtrial {
namespace {

constexpr double kLowestStartMm = 10.0;
constexpr double kHighestStartMm = 20.0;

}  // namespace

SimulatedHand make_exploring_hand(const SubjectModel& subject, const PlaneGeometry& plane,
                                  RandomStream& random) {
  HandOptions hand;
  hand.push_n = subject.push_n;
  hand.explore_s = subject.explore_s;
  hand.start_height_mm = random.uniform(kLowestStartMm, kHighestStartMm);
  ExplorationOptions exploration;
  exploration.slowest_mm_s = subject.slowest_mm_s;
  exploration.fastest_mm_s = subject.fastest_mm_s;
  exploration.duration_s = subject.explore_s;
  return {hand, ExplorationPath(plane, exploration, random)};
}

}  // namespace touchtrial
