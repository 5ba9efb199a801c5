#include "protocols/identification/planning/planner.hpp"

#include "analysis/report/text_figures.hpp"
#include "core/errors.hpp"
#include "core/hash.hpp"
#include "core/version.hpp"
#include "engine/pack/pack.hpp"
#include "protocols/identification/planning/power_report.hpp"
#include "protocols/identification/planning/power_runs.hpp"
#include "protocols/identification/planning/rehearsed_study.hpp"
#include "protocols/identification/planning/stated_people.hpp"
#include "protocols/session/stimulus_source.hpp"
#include "protocols/simulation/felt_knowledge.hpp"

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include <fmt/format.h>

namespace touchtrial::planning::identification {
namespace {

/// A digest of the fields of the pack that participants may feel.
std::string fields_digest(const study::StudyKey& key, const engine::Pack& pack) {
  FieldHasher hasher;
  for (const study::KeyedStimulus& keyed : key.stimuli) {
    const engine::PackEntry& entry = pack.entry(keyed.code);
    const std::string gains = fmt::format("{} {} {}", entry.gains.tangential_n,
                                          entry.gains.normal_n, entry.gains.height_mm);
    hasher.add(entry.code).add(ByteView(entry.checksum)).add(gains);
  }
  return to_hex(hasher.finish());
}

struct PowerPreparation {
  PowerPreparation(const study::Study& planned_study, const PowerOptions& options,
                   const PowerTools& tools)
      : study(planned_study),
        test(test_for(study, options)),
        assumed_people(stated_people(options, test)),
        subject(assumed_people ? simulation::SubjectModel{} : tools.subject()),
        key(tools.key()) {
    if (assumed_people) return;
    tools.prepare(key);
    pack.emplace(key.pack_folder);
  }

  static PrimaryTest test_for(const study::Study& study, const PowerOptions& options) {
    const PrimaryTest test = primary_test_of(study, labels(options));
    return options.margin ? as_noninferiority_test(test, *options.margin) : test;
  }

  static std::optional<StatedPeople> stated_people(const PowerOptions& options,
                                                   const PrimaryTest& test) {
    if (!options.mean) return std::nullopt;
    const StatedPeople people{*options.mean, options.sd_between, options.accuracy};
    require_possible(people, test);
    return people;
  }

  static std::optional<MethodLabels> labels(const PowerOptions& options) {
    if (options.methods.empty()) return std::nullopt;
    if (options.methods.size() == 2) return MethodLabels{options.methods[0], options.methods[1]};
    throw UsageError("--methods: give two methods, for instance --methods adaptive,tv-gabor");
  }

  [[nodiscard]] PowerSetting setting() const {
    return {study.name,
            study.protocol_name(),
            words_of(test, study),
            estimate_words(test),
            to_hex(key.seal),
            pack ? fields_digest(key, *pack) : std::string(kNoFields),
            assumed_people ? words_of(*assumed_people) : planning::words_of(subject),
            std::string(program_version()),
            study.trials.order != study::TrialOrder::uniform,
            analysis::device_words(
                {assumed_people ? analysis::kStatedPeople : simulation::recorded_device(subject)})};
  }

  const study::Study& study;
  PrimaryTest test;
  std::optional<StatedPeople> assumed_people;  ///< if set, there are no stimuli and no pack
  simulation::SubjectModel subject;
  study::StudyKey key;
  std::optional<engine::Pack> pack;
};

PowerRuns run_plan(const PowerPreparation& prepared, const PowerPlan& plan, int jobs,
                   const PowerTools& tools) {
  const study::Progress progress = tools.progress("simulating");
  const int max_participants = plan.participants.back();
  if (prepared.assumed_people) {
    const StatedRehearsal study(prepared.study, *prepared.assumed_people, prepared.test,
                                max_participants);
    return make_runs(study, prepared.test, prepared.setting(), plan, jobs, progress);
  }
  const session::StimulusSource source(*prepared.pack, prepared.key.study.rendering);
  const simulation::LabelledFields fields(prepared.key, source);
  const PrecomputedPerception perception(fields, prepared.study, prepared.subject,
                                         {plan.explorations, plan.trainings, plan.seed, jobs},
                                         tools.progress("feeling"));
  const RehearsedStudy study(prepared.study, prepared.subject, prepared.test, perception,
                             max_participants);
  return make_runs(study, prepared.test, prepared.setting(), plan, jobs, progress);
}

class IdentificationPlanner final : public Planner {
 public:
  std::span<const std::string_view> options() const override {
    static constexpr std::array<std::string_view, 7> kOptions = {
        "--methods",  "--margin",       "--mean",     "--sd-between",
        "--accuracy", "--explorations", "--trainings"};
    return kOptions;
  }

  PowerResult power(const study::Study& study, const PowerOptions& options,
                    const PowerTools& tools) const override {
    const PowerPreparation prepared(study, options, tools);
    PowerPlan plan = options.plan;
    plan.level = prepared.test.alpha;
    plan.margin = prepared.test.margin.value_or(0.0);
    const PowerReport report = make_power_report(run_plan(prepared, plan, options.jobs, tools));
    return {options.json ? power_json(report) : power_text(report), power_curve(report)};
  }
};

}  // namespace

const Planner& identification_planner() {
  static const IdentificationPlanner planner;
  return planner;
}

}  // namespace touchtrial::planning::identification
