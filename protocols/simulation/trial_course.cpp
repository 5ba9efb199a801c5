#include "protocols/simulation/trial_course.hpp"

#include "study/study.hpp"

namespace touchtrial::simulation {

TrialCourse course_of(const study::Study& study, const study::Schedule& schedule) {
  TrialCourse course;
  for (const study::Trial& trial : schedule.trials) {
    TrialPlace& place = course.emplace_back();
    place.block = trial.place.block;
    place.carries_over = trial.role != study::Role::catch_trial;
    if (place.carries_over) {
      place.label = study.classes[static_cast<std::size_t>(trial.field().class_index)].label;
    }
  }
  return course;
}

}  // namespace touchtrial::simulation
