/// \file Schedules of the identification protocols: blocks by method or mixed, the choice of
/// images, and catch trials. Private to protocols/identification.
#pragma once

#include "study/schedule.hpp"
#include "study/study.hpp"

namespace touchtrial::study::identification {

/// The functions of study/schedule.hpp for both protocols of identification.
[[nodiscard]] Schedule scheduled(const Study& study, const ScheduleDraw& draw);
[[nodiscard]] std::vector<Presentation> scheduled_again(const Study& study,
                                                        const ScheduleDraw& draw, int block,
                                                        int restarts_before, int first_trial);
[[nodiscard]] std::string rule_of_schedule(const Study& study);

}  // namespace touchtrial::study::identification
