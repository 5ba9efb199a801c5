/// \file A tiny study for many simulations.
#pragma once

#include "protocols/identification/planning/power_runs.hpp"
#include "protocols/identification/planning/rehearsed_study.hpp"
#include "protocols/session/stimulus_source.hpp"
#include "protocols/session/tiny_study.hpp"
#include "protocols/simulation/own_knowledge.hpp"

#include <algorithm>
#include <memory>

namespace touchtrial {

/// A subject who explores briefly: the tests need many explorations, but not good ones.
[[nodiscard]] inline simulation::SubjectModel hasty_subject() {
  return {.feature_noise = 0.5,
          .feature_noise_spread = 0.3,
          .lapse = 0.05,
          .lapse_spread = 0.5,
          .position_bias = 0.3,
          .position_bias_spread = 0.3,
          .class_bias_spread = 0.3,
          .explore_s = 1.5,
          .training_passes = 4};
}

/// With the secrets of the study's simulations, which follow from its seed.
[[nodiscard]] inline TinyStudyOptions as_simulated(TinyStudyOptions options) {
  options.secret = kTinyStudySeed;
  return options;
}

/// Feels every exploration anew through hand, device and servo, exactly as `simulate` does: the
/// slow reference of PrecomputedPerception. Refers to its arguments, which must outlive it.
class ServoFeelings final : public planning::identification::PerceptionSource {
 public:
  ServoFeelings(const simulation::LabelledFields& fields, const study::Study& study,
                const simulation::SubjectModel& subject)
      : fields_(fields), study_(study), subject_(subject) {}

  [[nodiscard]] std::shared_ptr<const simulation::FeltKnowledge> knowledge(
      std::uint64_t study_seed) const override {
    return simulation::learn(fields_, study_, subject_, study_seed, 1);
  }
  [[nodiscard]] engine::FeltFeatures felt(
      const study::StimulusIndex& stimulus,
      const planning::identification::FeltTrial& trial) const override {
    const auto field =
        std::ranges::find(fields_.all(), stimulus, &simulation::LabelledField::stimulus);
    return simulation::feel_trial(*field, trial.gain_db, fields_.plane(), study_, subject_,
                                  trial.study_seed, trial.participant, trial.nth);
  }

 private:
  const simulation::LabelledFields& fields_;
  const study::Study& study_;
  const simulation::SubjectModel& subject_;
};

/// A tiny study and what its simulated studies refer to.
struct RehearsedTinyStudy {
  explicit RehearsedTinyStudy(const TinyStudyOptions& options = {},
                              const simulation::SubjectModel& model = hasty_subject())
      : tiny(as_simulated(options)),
        subject(model),
        test(planning::identification::primary_test_of(tiny.key().study, {})),
        source(tiny.pack(), tiny.key().study.rendering),
        fields(tiny.key(), source),
        servo(fields, tiny.key().study, subject) {}

  [[nodiscard]] planning::identification::PrecomputedPerception bank(int explorations = 20,
                                                                     int trainings = 3,
                                                                     std::uint64_t seed = 1,
                                                                     int jobs = 2) const {
    return {fields, tiny.key().study, subject, {explorations, trainings, seed, jobs}};
  }
  [[nodiscard]] planning::identification::RehearsedStudy planned(
      const planning::identification::PerceptionSource& feelings, int most = 12) const {
    return {tiny.key().study, subject, test, feelings, most};
  }

  TinyStudy tiny;
  simulation::SubjectModel subject;
  planning::identification::PrimaryTest test;
  session::StimulusSource source;
  simulation::LabelledFields fields;
  ServoFeelings servo;
};

}  // namespace touchtrial
