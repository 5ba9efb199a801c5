#include "protocols/procedures/kinds.hpp"

#include <algorithm>
#include <numeric>
#include <stdexcept>

namespace touchtrial::procedures {
namespace {

/// Presents a fixed list of levels, regardless of answers.
class ConstantStimuli final : public Procedure {
 public:
  explicit ConstantStimuli(std::vector<std::size_t> order) : order_(std::move(order)) {}
  [[nodiscard]] std::size_t next() const override { return order_[position_]; }
  void answer(bool /*correct*/) override { position_ = std::min(position_ + 1, order_.size() - 1); }

 private:
  std::vector<std::size_t> order_;
  std::size_t position_ = 0;
};

}  // namespace

std::unique_ptr<Procedure> make_constant_stimuli(const TrackSettings& settings,
                                                 RandomStream& stream) {
  const std::size_t levels = settings.levels.size();
  const auto trials = static_cast<std::size_t>(settings.trials);
  if (trials % levels != 0) {
    throw std::invalid_argument(
        "constant stimuli: trials must be a multiple of the number of levels");
  }
  std::vector<std::size_t> round(levels);
  std::iota(round.begin(), round.end(), std::size_t{0});
  std::vector<std::size_t> order;
  if (settings.blocked) {
    shuffle(std::span(round), stream);
    for (const std::size_t level : round) order.insert(order.end(), trials / levels, level);
  } else {
    // Every level occurs once before any is repeated, so that the order is balanced over the track.
    while (order.size() < trials) {
      shuffle(std::span(round), stream);
      order.insert(order.end(), round.begin(), round.end());
    }
  }
  return std::make_unique<ConstantStimuli>(std::move(order));
}

}  // namespace touchtrial::procedures
