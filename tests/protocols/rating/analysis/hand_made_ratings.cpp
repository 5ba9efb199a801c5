#include "protocols/rating/analysis/hand_made_ratings.hpp"

#include "analysis/hand_made_study.hpp"
#include "core/strict_json.hpp"
#include "protocols/rating/study/rating.hpp"

#include <variant>

namespace touchtrial {

std::string said_in(const analysis::Document& document) {
  std::string said;
  for (const analysis::Section& section : document.sections) {
    for (const analysis::Block& block : section.blocks) {
      if (const auto* text = std::get_if<analysis::CitedText>(&block)) said += text->text + "\n";
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
  set_classes(outcomes, classes);
  for (const std::string& label : methods) outcomes.design.methods.emplace_back().label = label;
  outcomes.methods = methods;
}

void HandMadeRatings::session(bool counted) {
  add_session(outcomes, counted);
}

void HandMadeRatings::rated(int session, int texture_class, int method,
                            const std::vector<double>& values) {
  analysis::TrialOutcome& trial = add_trial(outcomes, session);
  trial.stimulus = {texture_class, 0, method};
  trial.has_stimulus = true;
  trial.scored = true;
  trial.counted = outcomes.sessions.at(static_cast<std::size_t>(session - 1)).counted;
  trial.row.answer = RatingAnswer{values};
}

void HandMadeRatings::caught(int session, const std::vector<double>& values) {
  analysis::TrialOutcome& trial = add_trial(outcomes, session);
  trial.role = study::Role::catch_trial;
  trial.row.answer = RatingAnswer{values};
}

void HandMadeRatings::missed(int session, int texture_class, int method) {
  rated(session, texture_class, method, {});
  analysis::TrialOutcome& trial = outcomes.trials.back();
  trial.row.state = record::TrialState::timed_out;
  trial.row.answer.reset();
  trial.row.answered_at.reset();
}

}  // namespace touchtrial
