// What was computed, by what was registered, and with which program.
#include "analysis/report/methods_parts.hpp"
#include "core/hash.hpp"
#include "core/strict_json.hpp"
#include "core/text.hpp"
#include "core/version.hpp"
#include "study/registration_words.hpp"
#include "study/setting_words.hpp"

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

constexpr std::size_t kDigitsOfHash = 16;

std::vector<Source> sources_of(const study::RegisteredAnalysis& analysis) {
  if (analysis.test == study::RegisteredTest::crossover) {
    return {Source::hills_armitage, Source::senn};
  }
  if (analysis.test == study::RegisteredTest::t) return {Source::student};
  return {};
}

void say_registered(const study::RegisteredAnalysis& analysis, Paragraph& paragraph) {
  const bool has_test = analysis.estimand != study::Estimand::mean_threshold;
  if (!has_test) {
    paragraph.say(fmt::format("The registered estimand was this: {}; no test was registered.",
                              study::estimand_words(analysis)));
    return;
  }
  paragraph.say(fmt::format("The registered estimand was this: {}; it was tested by {}, at α = {}.",
                            study::estimand_words(analysis), study::test_words(analysis),
                            number_text(analysis.alpha)),
                sources_of(analysis));
  if (analysis.margin || analysis.smallest_effect) {
    const auto [name, value] = study::size_field(analysis);
    paragraph.say(analysis.margin ? fmt::format("The margin was this: {}.", value)
                                  : fmt::format("The smallest effect worth having was {}.", value));
  }
  if (!analysis.looks.empty()) {
    paragraph.say(fmt::format("Interim looks were registered {}.", study::looks_words(analysis)),
                  {Source::lan_demets});
  }
  if (analysis.visits != study::RegisteredVisits::all) {
    paragraph.say(
        fmt::format("Of the visits, the {} alone entered.",
                    analysis.visits == study::RegisteredVisits::first ? "first" : "last"));
  }
}

void say_question(const study::Registration& registration, Paragraph& paragraph) {
  if (registration.analysis) return say_registered(*registration.analysis, paragraph);
  if (registration.primary_test.empty()) return;
  paragraph.say(fmt::format("The primary test that was fixed beforehand was: {}",
                            quoted_statement(registration.primary_test)));
}

/// ", and 12 of 480 scored trials did not meet it"
std::string trials_words(const Outcomes& outcomes) {
  int trials = 0;
  int invalid = 0;
  int unanswered = 0;
  for (const TrialOutcome& one : outcomes.trials) {
    if (!one.counted) continue;
    ++trials;
    invalid += one.valid() ? 0 : 1;
    unanswered += one.row.answer ? 0 : 1;
  }
  if (trials == 0) return {};
  return fmt::format("; {} of {} did not meet it{}", invalid, counted(trials, "scored trial"),
                     unanswered > 0 ? fmt::format(", and {} had no answer", unanswered) : "");
}

std::string validity_sentence(const Outcomes& outcomes) {
  const study::Study& study = outcomes.design;
  const auto& analysis = study.registration.analysis;
  const bool decides = analysis && analysis->exclusion_rules &&
                       analysis->exclusion_rules->invalid_trials.has_value();
  return fmt::format("A trial was called valid by a rule that was fixed beforehand ({}); {}{}.",
                     joined_fields(study::fields_of(study.trials.validity)),
                     decides
                         ? "trials that were not counted towards the exclusion of sessions alone"
                         : "no trial was left out for it",
                     trials_words(outcomes));
}

std::string versions_sentence(const Outcomes& outcomes, const RecordedStudy& recorded) {
  const std::string now(program_version());
  std::string text;
  if (recorded.program_version.empty() || recorded.program_version == now) {
    text = fmt::format("Data were collected and analysed with Touchtrial {}", now);
  } else {
    text = fmt::format("Data were collected with Touchtrial {} and analysed with Touchtrial {}",
                       recorded.program_version, now);
  }
  std::vector<std::string> hashes;
  if (!outcomes.design.text.empty()) {
    hashes.push_back("study file " +
                     to_hex(sha256(bytes_of(outcomes.design.text))).substr(0, kDigitsOfHash));
  }
  if (!recorded.seal.empty()) hashes.push_back("seal " + recorded.seal.substr(0, kDigitsOfHash));
  if (!recorded.pack.empty()) hashes.push_back("stimuli " + recorded.pack.substr(0, kDigitsOfHash));
  if (hashes.empty()) return text + ".";
  return text + " (first digits of SHA-256: " + listed(hashes) + ").";
}

}  // namespace

Cited analysis_paragraph(const Outcomes& outcomes, const RecordedStudy& recorded,
                         const ProtocolMethods& protocol) {
  Paragraph paragraph;
  say_question(outcomes.design.registration, paragraph);
  paragraph.say(protocol.statistics);
  paragraph.say(validity_sentence(outcomes));
  paragraph.say(versions_sentence(outcomes, recorded));
  return paragraph.cited();
}

}  // namespace touchtrial::analysis
