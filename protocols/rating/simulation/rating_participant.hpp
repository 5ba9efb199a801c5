/// \file A simulated participant who rates how well a felt texture fits a picture: the nearer what
/// is felt is to what the picture made them expect, the better. Source: docs/rating.md, "Simulated
/// participants".
#pragma once

#include "protocols/rating/study/rating.hpp"
#include "protocols/simulation/condition.hpp"
#include "protocols/simulation/felt_decision.hpp"
#include "protocols/simulation/population.hpp"
#include "protocols/simulation/simulated_participant.hpp"

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace touchtrial::simulation::rating {

/// What a picture makes people expect to feel, by class label: the mean over the class's fields by
/// the methods that are no controls. Natural logarithms of newtons.
using Expectations = std::map<std::string, engine::FeltFeatures>;

/// Feels with noise of its own, and rates by the distance to the expectation beyond that noise,
/// in its standard deviations, on a part of the scale that is its own; or lapses, and rates
/// anything. A picture of which nothing is expected, as in practice, is rated in the middle. Refers
/// to subject, study and expectations, which must outlive it.
class RatingParticipant final : public SimulatedParticipant {
 public:
  /// \param number  from 1
  RatingParticipant(const SubjectModel& subject, const study::Study& study,
                    const Expectations& expectations, std::uint64_t seed, int number);

  void see_pictures(const std::vector<std::string>& /*labels*/) override {}
  void asked(const session::AnswerStep& step) override { picture_ = step.picture; }
  void rest() override { condition_.rest(begun()); }

 protected:
  [[nodiscard]] ParticipantAnswer choose(const engine::FeltFeatures& felt,
                                         RandomStream& random) override;
  void begin_visit(int visit, TrialCourse course) override;

 private:
  /// How well it fits, 0 to 1, before a place on the scale is chosen for it.
  [[nodiscard]] double fit_of(engine::FeltFeatures felt, double noise_factor,
                              RandomStream& random) const;

  const SubjectModel& subject_;
  const Expectations& expectations_;
  std::vector<study::Scale> scales_;
  std::uint64_t seed_;
  int number_;
  Individual individual_;
  Condition condition_;
  double shift_;    ///< of all this person's ratings, as a share of the scale
  double stretch_;  ///< of their differences
  std::string picture_;
};

/// \throws FileError if the pack lacks a stimulus
[[nodiscard]] std::unique_ptr<const Population> make_population(const PopulationSetting& setting);

}  // namespace touchtrial::simulation::rating
