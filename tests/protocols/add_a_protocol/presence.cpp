// A whole protocol: a participant feels the study's first texture or a smooth wall, at random, and
// says which. docs/add-a-protocol.md goes through this file part by part.
#include "add_a_protocol/presence.hpp"

#include "analysis/outcomes/study_head.hpp"
#include "analysis/report/results.hpp"
#include "analysis/statistics/proportion.hpp"
#include "core/random.hpp"
#include "protocols/simulation/population.hpp"
#include "study/protocol.hpp"
#include "study/study.hpp"

#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <utility>

namespace touchtrial::example {
namespace {

using study::Role;
using study::ScheduleDraw;
using study::Study;
using study::Trial;

constexpr int kTexture = 0;  // indices into the choices
constexpr int kSmooth = 1;

// 1. What the study file says, what is presented, and what is asked.

class PresenceTask final : public study::Task {
 public:
  /// \param each  trials with the texture, and as many with the smooth wall
  explicit PresenceTask(int each) : each_(each) {}

  void check(const JsonValue& file, const Study& study) const override {
    if (study.trials.catch_trials > 0) {
      file.refuse_below("/trials/catch", "must be 0: half of the trials are smooth already");
    }
  }
  std::string plaintext_settings() const override {
    return R"({"each": )" + std::to_string(each_) + "}";
  }
  std::string rule(const Study&) const override {
    return "presence 1; each=" + std::to_string(each_);
  }
  int scored_trials(const Study&) const override { return each_; }

  study::TrialQuestion ask(const Study& study, const study::Place&) const override {
    return {.question = study::ChoiceQuestion{.title = "What did you feel?",
                                              .choices = {{"texture"}, {"smooth"}}},
            .confidence_levels = study.session.confidence_levels};
  }
  std::unique_ptr<study::Order> order(const Study&, const ScheduleDraw& draw) const override {
    const Trial textured{.planes = {{.field = {}}}, .right = kTexture};
    const Trial smooth{.role = Role::catch_trial, .planes = {{.field = {}, .blank = true}}};
    study::Schedule schedule{.trials = {}, .layout = {kTexture, kSmooth}};
    schedule.trials.insert(schedule.trials.end(), each_, textured);
    schedule.trials.insert(schedule.trials.end(), each_, smooth);
    RandomStream random(draw.secret, "presence");
    shuffle(std::span<Trial>(schedule.trials), random);
    int number = 0;
    for (Trial& trial : schedule.trials) trial.place.trial = ++number;
    return std::make_unique<study::Order>(std::move(schedule), draw.secret);
  }

 private:
  int each_;
};

std::shared_ptr<const study::Task> read_task(const std::optional<JsonValue>& section) {
  int each = 10;
  if (section) {
    const JsonObject object = section->object({"each"});
    if (const auto given = object.find("each")) each = static_cast<int>(given->integer(1, 500));
  }
  return std::make_shared<PresenceTask>(each);
}

// 2. How a simulated participant answers.

class PresenceParticipant final : public simulation::SimulatedParticipant {
 public:
  using SimulatedParticipant::SimulatedParticipant;
  void see_pictures(const std::vector<std::string>&) override {}

 private:
  /// "Texture" if the lateral force is above 5 mN in root mean square.
  simulation::ParticipantAnswer choose(const engine::FeltFeatures& felt, RandomStream&) override {
    double square_n2 = 0.0;
    for (int band = 0; band < engine::kFeltBands; ++band) {
      square_n2 += std::exp(2.0 * felt[static_cast<std::size_t>(engine::kLateralBandsAt + band)]);
    }
    constexpr double kThreshold_n = 0.005;
    return {std::sqrt(square_n2) > kThreshold_n ? kTexture : kSmooth, std::chrono::seconds(1)};
  }
};

class PresencePopulation final : public simulation::Population {
 public:
  explicit PresencePopulation(const simulation::PopulationSetting& setting)
      : subject_(setting.subject), seed_(setting.seed) {}
  std::unique_ptr<simulation::SimulatedParticipant> participant(int number) const override {
    return std::make_unique<PresenceParticipant>(subject_, seed_, number);
  }

 private:
  const simulation::SubjectModel& subject_;
  std::uint64_t seed_;
};

std::unique_ptr<const simulation::Population> make_presence(
    const simulation::PopulationSetting& setting) {
  return std::make_unique<PresencePopulation>(setting);
}

// 3. What the report says.

class PresenceResults final : public analysis::Results {
 public:
  explicit PresenceResults(const analysis::Outcomes& outcomes) : head_(head_of(outcomes)) {
    for (const analysis::TrialOutcome& trial : outcomes.trials) {
      if (!trial.response) continue;
      const bool said_texture = *trial.response == kTexture;
      analysis::Proportion& of = trial.scored ? hits_ : false_alarms_;
      ++of.n;
      of.correct += said_texture ? 1 : 0;
    }
  }
  const analysis::StudyHead& head() const override { return head_; }
  std::string json() const override {
    return framed_json(head_, R"({"hits": )" + std::to_string(hits_.correct) +
                                  R"(, "false_alarms": )" + std::to_string(false_alarms_.correct) +
                                  "}");
  }
  analysis::Document document(const analysis::Provenance& provenance,
                              const analysis::Pictures&) const override {
    analysis::Table table{
        "presence", "Answers", {{"presented", analysis::Align::left}, {"n"}, {"said texture"}}};
    const auto add = [&](const char* what, const analysis::Proportion& of) {
      table.rows.push_back({what, std::to_string(of.n), std::to_string(of.correct)});
    };
    add("texture", hits_);
    add("smooth wall", false_alarms_);
    return framed_document(head_, {"result", "Result", {table}}, {}, provenance);
  }

 private:
  analysis::StudyHead head_;
  analysis::Proportion hits_;
  analysis::Proportion false_alarms_;
};

class PresenceAnalysis final : public analysis::ProtocolAnalysis {
 public:
  std::unique_ptr<const analysis::Results> results(const analysis::Outcomes& outcomes,
                                                   const analysis::ReportOptions&) const override {
    return std::make_unique<PresenceResults>(outcomes);
  }
};

}  // namespace

void register_presence() {
  static constexpr study::Protocol kProtocol{
      .name = "presence", .section = "presence", .read = read_task, .all_methods = false};
  static const PresenceAnalysis analysis;
  study::add_protocol(kProtocol);
  simulation::add_population(kProtocol.name, make_presence);
  analysis::add_analysis(kProtocol.name, analysis);
}

}  // namespace touchtrial::example
