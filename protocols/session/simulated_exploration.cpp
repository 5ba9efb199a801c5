#include "protocols/session/simulated_exploration.hpp"

namespace touchtrial::session {
namespace {

constexpr double kLowestStartMm = 10.0;
constexpr double kHighestStartMm = 20.0;

}  // namespace

device::SimulatedHand make_exploring_hand(const SubjectModel& subject, const PlaneGeometry& plane,
                                          RandomStream& random) {
  device::HandOptions hand;
  hand.push_n = subject.push_n;
  hand.explore_s = subject.explore_s;
  hand.start_height_mm = random.uniform(kLowestStartMm, kHighestStartMm);
  device::ExplorationOptions exploration;
  exploration.slowest_mm_s = subject.slowest_mm_s;
  exploration.fastest_mm_s = subject.fastest_mm_s;
  exploration.duration_s = subject.explore_s;
  return {hand, device::ExplorationPath(plane, exploration, random)};
}

}  // namespace touchtrial::session
