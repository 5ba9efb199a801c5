#include "app/run/practice_of.hpp"

#include <algorithm>

namespace touchtrial {

ParticipantPractice::ParticipantPractice(const RunStudy& study, const PlaneGeometry& plane,
                                         int enrolment)
    : study_(study.key.study), enrolment_(enrolment) {
  if (study_.trials.practice == 0 || study_.practice.classes.empty()) return;
  set_.emplace(study_, weakest_gains(study.pack.manifest()), plane);
  textures_ = PracticeTextures{set_->plane(), [this](int number) { return round(number); }};
}

PracticeRound ParticipantPractice::round(int number) const {
  const std::vector<int> layout = practice_layout(study_, enrolment_, number);
  PracticeRound round;
  for (const int class_index : layout) {
    round.labels.push_back(study_.practice.classes[static_cast<std::size_t>(class_index)].label);
    round.models.push_back(&set_->model(class_index));
  }
  for (const int class_index : practice_round(study_, enrolment_, number)) {
    const auto place = std::ranges::find(layout, class_index);
    round.order.push_back(static_cast<int>(place - layout.begin()));
  }
  return round;
}

}  // namespace touchtrial
