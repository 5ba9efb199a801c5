#include "app/run/practice_of.hpp"

#include <algorithm>

namespace touchtrial::app {

ParticipantPractice::ParticipantPractice(const RunStudy& study, const PlaneGeometry& plane,
                                         int enrolment)
    : study_(study.key.study), enrolment_(enrolment) {
  if (study_.trials.practice == 0 || study_.practice.classes.empty()) return;
  set_.emplace(study_, design::weakest_gains(study.pack.manifest()), plane);
  textures_ =
      session::PracticeTextures{set_->plane(), [this](int number) { return round(number); }};
}

session::PracticeRound ParticipantPractice::round(int number) const {
  const std::vector<int> layout = design::practice_layout(study_, enrolment_, number);
  session::PracticeRound round;
  for (const int class_index : layout) {
    round.labels.push_back(study_.practice.classes[static_cast<std::size_t>(class_index)].label);
    round.models.push_back(&set_->model(class_index));
  }
  for (const int class_index : design::practice_round(study_, enrolment_, number)) {
    const auto place = std::ranges::find(layout, class_index);
    round.order.push_back(static_cast<int>(place - layout.begin()));
  }
  return round;
}

}  // namespace touchtrial::app
