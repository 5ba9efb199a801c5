#include "protocols/procedures/kinds.hpp"

namespace touchtrial::procedures {
namespace {

class MinEntropy final : public Procedure {
 public:
  MinEntropy(const TrackSettings& settings, Nuisance nuisance)
      : posterior_(settings.levels, settings.grid),
        nuisance_(nuisance),
        next_(posterior_.best_level(nuisance)) {}

  [[nodiscard]] std::size_t next() const override { return next_; }

  void answer(bool correct) override {
    posterior_.observe(next_, correct);
    next_ = posterior_.best_level(nuisance_);
  }

 private:
  Posterior posterior_;
  Nuisance nuisance_;
  std::size_t next_;
};

}  // namespace

template <Nuisance nuisance>
std::unique_ptr<Procedure> make_min_entropy(const TrackSettings& settings,
                                            RandomStream& /*stream*/) {
  return std::make_unique<MinEntropy>(settings, nuisance);
}

template std::unique_ptr<Procedure> make_min_entropy<Nuisance::none>(const TrackSettings&,
                                                                     RandomStream&);
template std::unique_ptr<Procedure> make_min_entropy<Nuisance::lapse>(const TrackSettings&,
                                                                      RandomStream&);
template std::unique_ptr<Procedure> make_min_entropy<Nuisance::slope_and_lapse>(
    const TrackSettings&, RandomStream&);

}  // namespace touchtrial::procedures
