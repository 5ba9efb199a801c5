#include "protocols/rating/analysis/hand_made_ratings.hpp"

#include "core/strict_json.hpp"
#include "protocols/rating/study/rating.hpp"

#include <chrono>
#include <variant>

namespace touchtrial {

std::string said_in(const analysis::Document& document) {
  std::string said;
  for (const analysis::Section& section : document.sections) {
    for (const analysis::Block& block : section.blocks) {
      if (const auto* text = std::get_if<analysis::Cited>(&block)) said += text->text + "\n";
    }
  }
  return said;
}

HandMadeRatings::HandMadeRatings(const std::string& section,
                                 const std::vector<std::string>& methods,
                                 const std::vector<std::string>& classes) {
  outcomes.study = "fits";
  outcomes.design.name = "fits";
  outcomes.design.protocol = &study::rating::protocol();
  outcomes.design.task = study::rating::protocol().read(parse_strict_json(section, "ratings"));
  for (const std::string& label : classes) {
    study::StudyClass& added = outcomes.design.classes.emplace_back();
    added.label = label;
    added.images.emplace_back(label + ".png");
    outcomes.exemplars.push_back({label + ".png"});
  }
  for (const std::string& label : methods) outcomes.design.methods.emplace_back().label = label;
  outcomes.classes = classes;
  outcomes.methods = methods;
  outcomes.state.closed = true;
  outcomes.state.unblinded = true;
}

void HandMadeRatings::session(bool counted) {
  const int number = static_cast<int>(outcomes.sessions.size()) + 1;
  analysis::SessionOutcome& added = outcomes.sessions.emplace_back();
  added.row.session = number;
  added.row.participant = "P" + std::to_string(number);
  added.row.enrolment = number;
  added.row.state = record::SessionState::completed;
  added.counted = counted;
}

analysis::TrialOutcome& HandMadeRatings::presented(int session) {
  const auto place = static_cast<int>(outcomes.trials.size()) + 1;
  analysis::TrialOutcome& trial = outcomes.trials.emplace_back();
  trial.participant = "P" + std::to_string(session);
  trial.row.session = session;
  trial.row.trial = place;
  trial.row.state = record::TrialState::answered;
  trial.row.presented_at = std::chrono::seconds(20 * place);
  trial.row.answered_at = trial.row.presented_at + std::chrono::seconds(8);
  return trial;
}

void HandMadeRatings::rated(int session, int texture_class, int method,
                            const std::vector<double>& values) {
  analysis::TrialOutcome& trial = presented(session);
  trial.stimulus = {texture_class, 0, method};
  trial.has_stimulus = true;
  trial.scored = true;
  trial.counted = outcomes.sessions.at(static_cast<std::size_t>(session - 1)).counted;
  trial.row.answer = Rated{values};
}

void HandMadeRatings::caught(int session, const std::vector<double>& values) {
  analysis::TrialOutcome& trial = presented(session);
  trial.role = study::Role::catch_trial;
  trial.row.answer = Rated{values};
}

void HandMadeRatings::missed(int session, int texture_class, int method) {
  rated(session, texture_class, method, {});
  analysis::TrialOutcome& trial = outcomes.trials.back();
  trial.row.state = record::TrialState::timed_out;
  trial.row.answer.reset();
  trial.row.answered_at.reset();
}

}  // namespace touchtrial
