#include "protocols/design/catch_trials.hpp"

#include <numeric>
#include <span>

namespace touchtrial::design {
namespace {

/// Which of the places after the first are taken: `count` of `places`.
std::vector<bool> random_places(std::size_t places, std::size_t count, RandomStream& random) {
  std::vector<std::size_t> later(places - 1);
  std::iota(later.begin(), later.end(), std::size_t{1});
  shuffle(std::span<std::size_t>(later), random);
  std::vector<bool> taken(places, false);
  for (std::size_t i = 0; i < count; ++i) taken[later[i]] = true;
  return taken;
}

}  // namespace

std::vector<Presentation> with_catch_trials(const std::vector<Presentation>& shown, int count,
                                            RandomStream& random) {
  if (count == 0) return shown;
  const auto caught = static_cast<std::size_t>(count);
  std::vector<Presentation> all;
  auto next = shown.begin();
  for (const bool is_catch : random_places(shown.size() + caught, caught, random)) {
    if (is_catch) {
      all.push_back(
          {.block = all.back().block, .kind = PresentationKind::catch_trial, .stimulus = {}});
    } else {
      all.push_back(*next++);
    }
  }
  return all;
}

}  // namespace touchtrial::design
