// The paragraph on data analysis.
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

std::vector<Source> sources_of(const study::RegisteredAnalysis& analysis) {
  if (analysis.test == study::RegisteredTest::crossover) {
    return {Source::hills_armitage, Source::senn};
  }
  if (analysis.test == study::RegisteredTest::t) return {Source::student};
  return {};
}

void add_registered_analysis(const study::RegisteredAnalysis& analysis, Paragraph& paragraph) {
  const bool has_test = analysis.estimand != study::Estimand::mean_threshold;
  if (!has_test) {
    paragraph.add(fmt::format("The registered estimand was: {}; no test was registered.",
                              study::estimand_words(analysis)));
    return;
  }
  paragraph.add(fmt::format("The registered estimand was: {}; it was tested by {}, at α = {}.",
                            study::estimand_words(analysis), study::test_words(analysis),
                            number_text(analysis.alpha)),
                sources_of(analysis));
  if (analysis.margin || analysis.smallest_effect) {
    const auto [name, value] = study::size_field(analysis);
    paragraph.add(analysis.margin ? fmt::format("The margin was {}.", value)
                                  : fmt::format("The smallest effect of interest was {}.", value));
  }
  if (!analysis.looks.empty()) {
    paragraph.add(fmt::format("Interim looks were registered {}.", study::looks_words(analysis)),
                  {Source::lan_demets});
  }
  if (analysis.visits != study::RegisteredVisits::all) {
    paragraph.add(
        fmt::format("Only the {} visit entered the analysis.",
                    analysis.visits == study::RegisteredVisits::first ? "first" : "last"));
  }
}

void add_primary_question(const study::Registration& registration, Paragraph& paragraph) {
  if (registration.analysis) return add_registered_analysis(*registration.analysis, paragraph);
  if (registration.primary_test.empty()) return;
  paragraph.add(fmt::format("The primary test was fixed in advance: {}",
                            quoted_statement(registration.primary_test)));
}

/// "; 12 of 480 scored trials did not meet it"
std::string trials_words(const Outcomes& outcomes) {
  int trials = 0;
  int invalid = 0;
  int unanswered = 0;
  for (const TrialOutcome& trial : outcomes.trials) {
    if (!trial.counted) continue;
    ++trials;
    invalid += trial.valid() ? 0 : 1;
    unanswered += trial.row.answer ? 0 : 1;
  }
  if (trials == 0) return {};
  return fmt::format("; {} of {} did not meet it{}", invalid, counted(trials, "scored trial"),
                     unanswered > 0 ? fmt::format(", and {} had no answer", unanswered) : "");
}

std::string validity_sentence(const Outcomes& outcomes) {
  const study::Study& study = outcomes.design;
  const auto& analysis = study.registration.analysis;
  const bool can_exclude_sessions = analysis && analysis->exclusion_rules &&
                                    analysis->exclusion_rules->invalid_trials.has_value();
  return fmt::format("A trial was called valid by a rule that was fixed in advance ({}); {}{}.",
                     joined_fields(study::fields_of(study.trials.validity)),
                     can_exclude_sessions
                         ? "invalid trials counted only towards the exclusion of sessions"
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
                     to_hex(sha256(bytes_of(outcomes.design.text))).substr(0, kHashDigits));
  }
  if (!recorded.seal.empty()) hashes.push_back("seal " + recorded.seal.substr(0, kHashDigits));
  if (!recorded.pack.empty()) hashes.push_back("stimuli " + recorded.pack.substr(0, kHashDigits));
  if (hashes.empty()) return text + ".";
  return text + " (first digits of SHA-256: " + listed(hashes) + ").";
}

}  // namespace

CitedText analysis_paragraph(const Outcomes& outcomes, const RecordedStudy& recorded,
                             const ProtocolMethods& protocol) {
  Paragraph paragraph;
  add_primary_question(outcomes.design.registration, paragraph);
  paragraph.add(protocol.statistics);
  paragraph.add(validity_sentence(outcomes));
  paragraph.add(versions_sentence(outcomes, recorded));
  return paragraph.cited();
}

}  // namespace touchtrial::analysis
