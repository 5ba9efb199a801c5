#include "app/experimenter/spoken_answers.hpp"

#include <algorithm>
#include <chrono>
#include <numeric>

namespace touchtrial::app {

void SpokenAnswers::see_pictures(const std::vector<std::string>& labels) {
  participant_.see_pictures(labels);
  positions_.resize(labels.size());
  std::iota(positions_.begin(), positions_.end(), 0);
  std::sort(positions_.begin(), positions_.end(), [&](int a, int b) {
    return labels[static_cast<std::size_t>(a)] < labels[static_cast<std::size_t>(b)];
  });
  sorted_.clear();
  for (const int position : positions_) {
    sorted_.push_back(labels[static_cast<std::size_t>(position)]);
  }
}

std::optional<session::StepReply> SpokenAnswers::attend(const session::Step& step) {
  const auto shown = participant_.attend(step);
  const auto* asked = std::get_if<session::AnswerStep>(&step);
  if (asked == nullptr || asked->sight != design::Sight::blindfold) return shown;
  if (shown && shown->explore_again) return shown;
  const auto spoken = entry_.spoken_answer(*asked, sorted_);
  if (!spoken) return std::nullopt;
  session::StepReply reply;
  reply.at = std::chrono::steady_clock::now();
  reply.position = positions_.at(spoken->label);
  if (spoken->first) reply.first_position = positions_.at(*spoken->first);
  reply.confidence = spoken->confidence;
  return reply;
}

}  // namespace touchtrial::app
