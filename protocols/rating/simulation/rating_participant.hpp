/// \file A simulated participant who rates how well a felt texture fits a picture. The rating
/// decreases with the texture's distance from the expectation that the picture raises. Source:
/// docs/rating.md, "Simulated participants".
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

/// Features that participants expect from the picture of a class, by label: the mean over the
/// class's fields of all methods except controls. Natural logarithms of newtons.
using Expectations = std::map<std::string, engine::FeltFeatures>;

/// Feels with noise, and rates by the distance from the expectation in standard deviations of that
/// noise, with an individual use of the scale. In a lapse, gives a random rating. Pictures without
/// an expectation, such as practice pictures, get the middle of the scale. Subject, study and
/// expectations must outlive it.
class RatingParticipant final : public SimulatedParticipant {
 public:
  /// \param number  from 1
  RatingParticipant(const SubjectModel& subject, const study::Study& study,
                    const Expectations& expectations, std::uint64_t seed, int number);

  void see_pictures(const std::vector<std::string>& /*labels*/) override {}
  void on_question(const session::AnswerStep& step) override { picture_ = step.picture; }
  void rest() override { condition_.rest(presentations_begun()); }

 protected:
  [[nodiscard]] ParticipantAnswer choose(const engine::FeltFeatures& felt,
                                         RandomStream& random) override;
  void begin_visit(int visit, TrialCourse course) override;

 private:
  /// The goodness of fit, 0 to 1, before it is mapped to the scale.
  [[nodiscard]] double fit_of(engine::FeltFeatures felt, double noise_factor,
                              RandomStream& random) const;

  const SubjectModel& subject_;
  const Expectations& expectations_;
  std::vector<study::Scale> scales_;
  std::uint64_t seed_;
  int number_;
  Individual individual_;
  Condition condition_;
  double shift_;    ///< added to all ratings, as a share of the scale
  double stretch_;  ///< factor on distances from the middle of the scale
  std::string picture_;
};

/// \throws FileError if the pack lacks a stimulus
[[nodiscard]] std::unique_ptr<const Population> make_population(const PopulationSetting& setting);

}  // namespace touchtrial::simulation::rating
