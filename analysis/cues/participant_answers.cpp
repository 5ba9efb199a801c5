#include "analysis/cues/participant_answers.hpp"

#include <utility>

namespace touchtrial {

ParticipantAnswers::ParticipantAnswers(std::string participant, int classes)
    : participant_(std::move(participant)), classes_(classes) {
  const auto side = static_cast<std::size_t>(classes);
  presented_.resize(side, 0);
  no_response_.resize(side, 0);
  human_.resize(side * side, 0.0);
  ideal_.fill(human_);
  ideal_of_answered_.fill(human_);
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
  for (std::size_t observer = 0; observer < kCues.size(); ++observer) {
    const AnswerShares& shares = trial.ideal[observer];
    right_[observer] += shares[trial.presented];
    for (int answer = 0; answer < classes_; ++answer) {
      ideal_[observer][row + answer] += shares[answer];
      if (trial.response) ideal_of_answered_[observer][row + answer] += shares[answer];
    }
  }
}

}  // namespace touchtrial
