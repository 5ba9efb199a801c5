/// \file Training before a study, and each participant's memory of it.
/// Source: docs/planning.md, "Training".
#pragma once

#include "protocols/simulation/felt_knowledge.hpp"
#include "protocols/simulation/subject_model.hpp"
#include "study/study.hpp"

#include <cstdint>
#include <memory>

namespace touchtrial::simulation {

/// The training explorations of a study's participants. With `shared` training, all participants
/// remember all of them; with `own` training there are four times as many, and each participant
/// remembers a quarter. The result depends on all arguments except `jobs`. Takes 1.5 ms per
/// exploration of 10 s.
/// \param study  the study of the fields
[[nodiscard]] std::shared_ptr<const FeltKnowledge> learn(const LabelledFields& fields,
                                                         const study::Study& study,
                                                         const SubjectModel& subject,
                                                         std::uint64_t seed, int jobs);

/// The part of `learnt` that one participant remembers; `learnt` itself if all remember the same.
/// Takes about 10 us for 40 examples.
/// \param learnt  from `learn` with this subject
/// \param number  the participant's number, from 1
[[nodiscard]] std::shared_ptr<const FeltKnowledge> memory_of(
    const std::shared_ptr<const FeltKnowledge>& learnt, const SubjectModel& subject,
    std::uint64_t seed, int number);

}  // namespace touchtrial::simulation
