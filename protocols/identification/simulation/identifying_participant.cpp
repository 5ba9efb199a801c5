#include "protocols/identification/simulation/identifying_participant.hpp"

#include "protocols/simulation/own_knowledge.hpp"

#include <utility>

namespace touchtrial::simulation::identification {
namespace {

class IdentifyingPopulation final : public Population {
 public:
  explicit IdentifyingPopulation(const PopulationSetting& setting)
      : subject_(setting.subject),
        seed_(setting.seed),
        trained_knowledge_(learn(LabelledFields(setting.key, setting.source), setting.key.study,
                                 setting.subject, setting.seed, setting.jobs)) {}

  std::unique_ptr<SimulatedParticipant> participant(int number) const override {
    return std::make_unique<IdentifyingParticipant>(
        subject_, memory_of(trained_knowledge_, subject_, seed_, number), seed_, number);
  }

 private:
  const SubjectModel& subject_;
  std::uint64_t seed_;
  std::shared_ptr<const FeltKnowledge> trained_knowledge_;
};

/// A pointer without ownership.
std::shared_ptr<const FeltKnowledge> unowned(const FeltKnowledge& knowledge) {
  return {std::shared_ptr<const FeltKnowledge>(), &knowledge};
}

}  // namespace

IdentifyingParticipant::IdentifyingParticipant(const SubjectModel& subject,
                                               std::shared_ptr<const FeltKnowledge> knowledge,
                                               std::uint64_t seed, int number)
    : SimulatedParticipant(subject, seed, number),
      subject_(subject),
      seed_(seed),
      number_(number),
      knowledge_(std::move(knowledge)),
      individual_(subject, seed, number),
      decision_(individual_, *knowledge_),
      condition_(subject, seed, number) {}

IdentifyingParticipant::IdentifyingParticipant(const SubjectModel& subject,
                                               const FeltKnowledge& knowledge, std::uint64_t seed,
                                               int number)
    : IdentifyingParticipant(subject, unowned(knowledge), seed, number) {}

void IdentifyingParticipant::see_pictures(const std::vector<std::string>& labels) {
  pictures_ = match_pictures(labels, subject_, individual_, *knowledge_);
}

void IdentifyingParticipant::begin_visit(int visit, TrialCourse course) {
  course_ = std::move(course);
  condition_ = Condition(subject_, seed_, number_, visit, static_cast<int>(course_.size()));
}

void IdentifyingParticipant::rest() {
  condition_.rest(presentations_begun());
}

ParticipantAnswer IdentifyingParticipant::choose(const engine::FeltFeatures& felt,
                                                 RandomStream& random) {
  const auto trial = static_cast<std::size_t>(presentations_begun());
  const TrialPlace place =
      trial >= 1 && trial <= course_.size() ? course_[trial - 1] : TrialPlace{};
  const ParticipantAnswer answer = decision_.answer(
      felt, pictures_, random, condition_.effects_on(presentations_begun(), place.block));
  end_trial(condition_, place, answer.position, pictures_, *knowledge_);
  return answer;
}

std::unique_ptr<const Population> make_population(const PopulationSetting& setting) {
  setting.subject.check_labels(setting.key.study);
  return std::make_unique<IdentifyingPopulation>(setting);
}

}  // namespace touchtrial::simulation::identification
