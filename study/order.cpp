#include "study/order.hpp"

#include <algorithm>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>

namespace touchtrial::study {

Order::Order(Schedule schedule, const SecretKey& secret)
    : schedule_(std::move(schedule)), secret_(secret) {}

bool Order::is_adaptive() const noexcept {
  return std::ranges::any_of(schedule_.trials, &std::vector<Plane>::empty, &Trial::planes);
}

std::vector<Trial> Order::redraw_block(int block, int restarts_before, int first_trial) const {
  std::vector<Trial> trials;
  for (const Trial& trial : schedule_.trials) {
    if (trial.place.block == block) trials.push_back(trial);
  }
  if (trials.empty() || restarts_before < 0) {
    throw std::invalid_argument("Order: the schedule has no such block or restart");
  }
  RandomStream random(secret_, "schedule: block " + std::to_string(block) + ", restart " +
                                   std::to_string(restarts_before + 1));
  shuffle(std::span<Trial>(trials), random);
  for (Trial& trial : trials) trial.place.trial = first_trial++;
  return trials;
}

double draw_rove_db(double range_db, RandomStream& random) {
  return range_db * (random.uniform() - 0.5);
}

}  // namespace touchtrial::study
