// Who took part.
#include "analysis/outcomes/collection_records.hpp"
#include "analysis/report/methods_parts.hpp"
#include "core/text.hpp"
#include "study/registration_words.hpp"

#include <algorithm>
#include <map>
#include <set>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

std::string people_noun(const StudyHead& head) {
  return head.simulated ? "simulated participant" : "participant";
}

/// "1 withdrew and had the data erased", for a reason of which there is at least one.
void note_leaving(int people, const char* words, std::vector<std::string>& leaving) {
  if (people > 0) leaving.push_back(fmt::format("{} {}", people, words));
}

std::string excluded_words(const ParticipantFlow& flow) {
  std::vector<std::string> reasons;
  for (const std::string& reason : flow.exclusion_reasons) {
    if (!reason.empty()) reasons.push_back(reason);
  }
  return reasons.empty() ? "excluded" : "excluded (" + listed(reasons) + ")";
}

std::string leaving_words(const ParticipantFlow& flow) {
  std::vector<std::string> leaving;
  note_leaving(flow.erased, "withdrew and had the data erased", leaving);
  note_leaving(flow.replaced, "replaced by somebody else", leaving);
  if (flow.excluded > 0) {
    leaving.push_back(fmt::format("{} {}", flow.excluded, excluded_words(flow)));
  }
  note_leaving(flow.stopped, "with a session that was stopped early", leaving);
  note_leaving(flow.open, "with a session that had not ended", leaving);
  note_leaving(flow.other_kind, "in pilot or simulated sessions", leaving);
  note_leaving(flow.unseen, "completed after the interim look", leaving);
  return listed(leaving, " and ");
}

std::string number_sentence(const StudyHead& head) {
  const ParticipantFlow& flow = head.collection.flow;
  const std::string pilot = head.pilot ? " This was a pilot." : "";
  const std::string leaving = leaving_words(flow);
  if (leaving.empty()) {
    return fmt::format("In all, {} took part.", counted(head.participants, people_noun(head))) +
           pilot;
  }
  return fmt::format("In all, {} were enrolled and {} analysed; left out were {}.",
                     counted(flow.enrolled, people_noun(head)), head.participants, leaving) +
         pilot;
}

std::string simulated_sentence(const StudyHead& head) {
  if (!head.simulated) return {};
  return "Models of a hand and of a sense of touch took the place of people, so that everything "
         "below on what participants saw, heard, were told and were asked is what the study "
         "prescribes for people.";
}

std::string dates_sentence(const StudyHead& head) {
  const auto dates = dates_of(head.collection.sessions);
  if (!dates) return {};
  if (dates->first == dates->last) return "All sessions took place on " + dates->first + ".";
  return "Sessions took place from " + dates->first + " to " + dates->last + ".";
}

/// "age 20-29 (12)", without characteristics whose bands are all too small to be shown.
void say_demographics(const StudyHead& head, Paragraph& paragraph) {
  std::vector<std::string> all;
  bool has_hand = false;
  for (const Characteristic& one : head.demographics) {
    if (one.bands.empty()) continue;
    std::vector<std::string> bands;
    for (const Band& band : one.bands) {
      bands.push_back(fmt::format("{} ({})", band.name, band.people));
    }
    if (one.others > 0) bands.push_back(fmt::format("others and not told ({})", one.others));
    all.push_back(one.name + ' ' + listed(bands));
    has_hand = has_hand || one.name == "handedness";
  }
  if (all.empty()) return;
  std::string text;
  for (const std::string& one : all) text += (text.empty() ? "" : "; ") + one;
  text = fmt::format("By their own account, in bands of {} people or more: {}", kMinOfBand, text);
  if (has_hand) text += ", by the short form of the Edinburgh Handedness Inventory";
  paragraph.say(text + ".", has_hand ? std::vector{Source::veale} : std::vector<Source>{});
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
    return fmt::format("The rules for exclusion that were fixed beforehand were: {}.",
                       study::rules_words(*registration.analysis->exclusion_rules));
  }
  if (registration.exclusions.empty()) return {};
  return fmt::format("The rule for exclusions that was fixed beforehand was: {}",
                     quoted_statement(registration.exclusions));
}

}  // namespace

Cited participants_paragraph(const StudyHead& head, const Outcomes& outcomes) {
  Paragraph paragraph;
  paragraph.say(number_sentence(head));
  paragraph.say(simulated_sentence(head));
  paragraph.say(dates_sentence(head));
  say_demographics(head, paragraph);
  paragraph.say(groups_sentence(head, outcomes));
  paragraph.say(head.simulated ? std::string() : ethics_sentence(outcomes.design.session));
  paragraph.say(size_sentence(head.registration));
  paragraph.say(exclusions_sentence(head.registration));
  return paragraph.cited();
}

}  // namespace touchtrial::analysis
