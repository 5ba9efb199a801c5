#include "analysis/planning/feelings.hpp"

#include "core/random.hpp"

#include <algorithm>

namespace touchtrial::planning {
namespace {

session::FeltBankOptions bank_options(const BankedFeelingsOptions& options) {
  return {options.explorations, options.seed, options.jobs};
}

/// Trainings are of other seeds than the studies that have them.
std::uint64_t training_seed(std::uint64_t seed, int training) {
  return RandomStream(seed, "power: training", static_cast<std::uint64_t>(training)).bits();
}

}  // namespace

BankedFeelings::BankedFeelings(const session::LabelledFields& fields, const design::Study& study,
                               const session::SubjectModel& subject,
                               const BankedFeelingsOptions& options,
                               const design::Progress& progress)
    : bank_(fields, study, subject, bank_options(options), progress) {
  for (int i = 0; i < options.trainings; ++i) {
    trainings_.push_back(std::make_shared<const session::FeltKnowledge>(
        session::learn_by_feeling(fields, subject, study.rendering.max_force_n,
                                  training_seed(options.seed, i), options.jobs)));
  }
}

std::shared_ptr<const session::FeltKnowledge> BankedFeelings::knowledge(
    std::uint64_t study_seed) const {
  RandomStream random(study_seed, "power: which training");
  return trainings_[random.below(trainings_.size())];
}

engine::FeltFeatures BankedFeelings::felt(const design::StimulusIndex& stimulus,
                                          const FeltTrial& trial) const {
  // Of 2^64 draws no exploration has more than any other but for one: no need to reject.
  const auto explorations = static_cast<std::uint64_t>(bank_.explorations());
  return bank_.felt(bank_.place_of(stimulus))[trial.draw % explorations];
}

std::shared_ptr<const session::FeltKnowledge> ServoFeelings::knowledge(
    std::uint64_t study_seed) const {
  return std::make_shared<const session::FeltKnowledge>(
      session::learn_by_feeling(fields_, subject_, study_.rendering.max_force_n, study_seed, 1));
}

engine::FeltFeatures ServoFeelings::felt(const design::StimulusIndex& stimulus,
                                         const FeltTrial& trial) const {
  const auto& all = fields_.all();
  const auto field = std::ranges::find(all, stimulus, &session::LabelledField::stimulus);
  return session::feel_trial(*field, fields_.plane(), study_, subject_, trial.study_seed,
                             trial.participant, trial.nth);
}

}  // namespace touchtrial::planning
