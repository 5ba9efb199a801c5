// The paragraph on participants.
#include "analysis/outcomes/collection_records.hpp"
#include "analysis/report/methods_parts.hpp"
#include "analysis/report/text_figures.hpp"
#include "core/text.hpp"
#include "study/registration_words.hpp"

#include <algorithm>
#include <map>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace touchtrial::analysis {
namespace {

std::string people_noun(const StudyHead& head) {
  return head.simulated ? "simulated participant" : "participant";
}

std::string excluded_words(const ParticipantFlow& flow) {
  std::vector<std::string> reasons;
  for (const std::string& reason : flow.exclusion_reasons) {
    if (!reason.empty()) reasons.push_back(reason);
  }
  return reasons.empty() ? "excluded" : "excluded (" + listed(reasons) + ")";
}

std::string losses_words(const ParticipantFlow& flow) {
  std::vector<std::string> losses;
  add_people(flow.erased, "withdrew and had the data erased", losses);
  add_people(flow.replaced, "replaced by another participant", losses);
  if (flow.excluded > 0) {
    losses.push_back(fmt::format("{} {}", flow.excluded, excluded_words(flow)));
  }
  add_people(flow.stopped, "with a session that was stopped early", losses);
  add_people(flow.open, "with a session that had not ended", losses);
  add_people(flow.other_kind, "in pilot or simulated sessions", losses);
  add_people(flow.unseen, "completed after the interim look", losses);
  return listed(losses, " and ");
}

std::string number_sentence(const StudyHead& head) {
  const ParticipantFlow& flow = head.collection.flow;
  const std::string losses = losses_words(flow);
  const std::string text =
      losses.empty()
          ? fmt::format("In all, {} took part.", counted(head.participants, people_noun(head)))
          : fmt::format("In all, {} were enrolled and {} analysed; left out were {}.",
                        counted(flow.enrolled, people_noun(head)), head.participants, losses);
  return text + (head.pilot ? " This was a pilot." : "");
}

std::string simulated_sentence(const StudyHead& head) {
  if (!head.simulated) return {};
  return "Models of a hand and of the sense of touch replaced people. Statements below on what "
         "participants saw, heard, were told and were asked describe what the study prescribes for "
         "people.";
}

std::string dates_sentence(const StudyHead& head) {
  const auto dates = dates_of(head.collection.sessions);
  if (!dates) return {};
  if (dates->first == dates->last) return "All sessions took place on " + dates->first + ".";
  return "Sessions took place from " + dates->first + " to " + dates->last + ".";
}

/// Adds "age 20-29 (12)", without characteristics whose bands are all too small.
void add_demographics(const StudyHead& head, Paragraph& paragraph) {
  std::vector<std::string> all;
  bool has_hand = false;
  for (const Characteristic& characteristic : head.demographics) {
    if (characteristic.bands.empty()) continue;
    std::vector<std::string> bands;
    for (const Band& band : characteristic.bands) {
      bands.push_back(fmt::format("{} ({})", band.name, band.people));
    }
    if (characteristic.others > 0)
      bands.push_back(fmt::format("others and not stated ({})", characteristic.others));
    all.push_back(characteristic.name + ' ' + listed(bands));
    has_hand = has_hand || characteristic.name == "handedness";
  }
  if (all.empty()) return;
  std::string text = fmt::format("Self-reported, in bands of at least {} people: {}",
                                 kMinBandPeople, fmt::join(all, "; "));
  if (has_hand) text += ", by the short form of the Edinburgh Handedness Inventory";
  paragraph.add(text + ".", has_hand ? std::vector{Source::veale} : std::vector<Source>{});
}

std::string groups_sentence(const StudyHead& head, const Outcomes& outcomes) {
  const std::vector<std::string>& labels = outcomes.design.groups.labels;
  if (labels.empty()) return {};
  std::map<std::string, std::set<std::string>> people;
  for (const SessionRecord* session : counted_records(head, outcomes)) {
    people[session->group].insert(session->row.participant);
  }
  std::vector<std::string> groups;
  for (const std::string& label : labels) {
    groups.push_back(fmt::format("{} (n = {})", label, people[label].size()));
  }
  return fmt::format("They were assigned at random to the groups {}{}.", listed(groups, " and "),
                     outcomes.design.groups.open ? ", which the experimenter knew" : "");
}

std::string ethics_sentence(const study::SessionPlan& session) {
  std::string text;
  if (!session.consent_version.empty()) {
    text = fmt::format("They gave written informed consent (form {}).", session.consent_version);
  }
  if (!session.ethics_number.empty()) {
    text += fmt::format("{}The study was approved under the number {}.", text.empty() ? "" : " ",
                        session.ethics_number);
  }
  return text;
}

std::string size_sentence(const study::Registration& registration) {
  std::string text;
  if (registration.participants > 0) {
    text = fmt::format("The sample size of {} was fixed before the first participant.",
                       registration.participants);
  }
  if (!registration.stopping_rule.empty()) {
    text += fmt::format("{}The stopping rule was: {}", text.empty() ? "" : " ",
                        quoted_statement(registration.stopping_rule));
  }
  return text;
}

std::string exclusions_sentence(const study::Registration& registration) {
  if (registration.analysis && registration.analysis->exclusion_rules) {
    return fmt::format("The rules for exclusion were fixed in advance: {}.",
                       study::rules_words(*registration.analysis->exclusion_rules));
  }
  if (registration.exclusions.empty()) return {};
  return fmt::format("The rule for exclusion was fixed in advance: {}",
                     quoted_statement(registration.exclusions));
}

}  // namespace

CitedText participants_paragraph(const StudyHead& head, const Outcomes& outcomes) {
  Paragraph paragraph;
  paragraph.add(number_sentence(head));
  paragraph.add(simulated_sentence(head));
  paragraph.add(dates_sentence(head));
  add_demographics(head, paragraph);
  paragraph.add(groups_sentence(head, outcomes));
  paragraph.add(head.simulated ? std::string() : ethics_sentence(outcomes.design.session));
  paragraph.add(size_sentence(head.registration));
  paragraph.add(exclusions_sentence(head.registration));
  return paragraph.cited();
}

}  // namespace touchtrial::analysis
