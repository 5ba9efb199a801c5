#include "protocols/identification/simulation/identifying_participant.hpp"

namespace touchtrial::simulation::identification {
namespace {

class IdentifyingPopulation final : public Population {
 public:
  explicit IdentifyingPopulation(const PopulationSetting& setting)
      : subject_(setting.subject),
        seed_(setting.seed),
        knowledge_(learn_by_feeling(LabelledFields(setting.key, setting.source), setting.subject,
                                    setting.key.study.rendering.max_force_n, setting.seed,
                                    setting.jobs)) {}

  std::unique_ptr<SimulatedParticipant> participant(int number) const override {
    return std::make_unique<IdentifyingParticipant>(subject_, knowledge_, seed_, number);
  }

 private:
  const SubjectModel& subject_;
  std::uint64_t seed_;
  FeltKnowledge knowledge_;
};

}  // namespace

IdentifyingParticipant::IdentifyingParticipant(const SubjectModel& subject,
                                               const FeltKnowledge& knowledge, std::uint64_t seed,
                                               int number)
    : SimulatedParticipant(subject, seed, number),
      subject_(subject),
      knowledge_(knowledge),
      individual_(subject, seed, number),
      decision_(individual_, knowledge) {}

void IdentifyingParticipant::see_pictures(const std::vector<std::string>& labels) {
  pictures_ = see(labels, subject_, individual_, knowledge_);
}

ParticipantAnswer IdentifyingParticipant::choose(const engine::FeltFeatures& felt,
                                                 RandomStream& random) {
  return decision_.answer(felt, pictures_, random);
}

std::unique_ptr<const Population> make_population(const PopulationSetting& setting) {
  setting.subject.check_labels(setting.key.study);
  return std::make_unique<IdentifyingPopulation>(setting);
}

}  // namespace touchtrial::simulation::identification
