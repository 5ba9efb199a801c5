#include "analysis/cues/participant_answers.hpp"

#include <utility>

namespace touchtrial::analysis {

ParticipantAnswers::ParticipantAnswers(std::string participant, int classes)
    : participant_(std::move(participant)), classes_(classes) {
  const auto side = static_cast<std::size_t>(classes);
  presented_.resize(side, 0);
  no_response_.resize(side, 0);
  human_.resize(side * side, 0.0);
  for (auto* counts : {&ideal_, &matched_, &ideal_of_answered_, &matched_of_answered_}) {
    counts->fill(human_);
  }
}

void ParticipantAnswers::add(const JudgedTrial& trial) {
  const int row = trial.presented * classes_;
  ++trials_;
  ++presented_[trial.presented];
  if (trial.response) {
    human_[row + *trial.response] += 1.0;
    human_right_ += *trial.response == trial.presented ? 1.0 : 0.0;
  } else {
    ++no_response_[trial.presented];
  }
  const auto add_shares = [&](FlatCounts& counts, const AnswerShares& shares) {
    for (int answer = 0; answer < classes_; ++answer) counts[row + answer] += shares[answer];
  };
  for (std::size_t observer = 0; observer < kCues.size(); ++observer) {
    right_[observer] += trial.ideal[observer][trial.presented];
    add_shares(ideal_[observer], trial.ideal[observer]);
    add_shares(matched_[observer], trial.matched[observer]);
    if (!trial.response) continue;
    add_shares(ideal_of_answered_[observer], trial.ideal[observer]);
    add_shares(matched_of_answered_[observer], trial.matched[observer]);
  }
}

}  // namespace touchtrial::analysis
