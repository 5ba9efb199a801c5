/// \file The JSON files of a BIDS dataset. Private to exports.
/// Source: BIDS specification 1.11; docs/exports.md.
#pragma once

#include "analysis/exports/bids/bids_people.hpp"
#include "analysis/exports/dataset.hpp"
#include "record/session_bodies.hpp"

#include <string>
#include <vector>

namespace touchtrial::analysis {

/// The version of BIDS that the datasets follow.
inline constexpr const char* kBidsVersion = "1.11.1";

[[nodiscard]] std::string dataset_description_json(const DatasetSource& study,
                                                   const DatasetOptions& options);
/// dataset_description.json of derivatives/touchtrial.
[[nodiscard]] std::string derivative_description_json(const DatasetSource& study);

/// Describes every column of a table except `participant_id` and `session_id`, which BIDS defines.
[[nodiscard]] std::string columns_json(const std::vector<std::string>& columns, bool simulated);

/// task-*_events.json: describes the columns of every *_events.tsv.
[[nodiscard]] std::string events_json(const DatasetSource& study,
                                      const std::vector<std::string>& columns);

/// task-*_beh.json: describes the task and the columns of every *_beh.tsv.
[[nodiscard]] std::string task_json(const DatasetSource& study, const DatasetOptions& options,
                                    const std::vector<std::string>& columns);

/// phenotype/<name>.json: the questions and their options.
/// \param language  of the wording
[[nodiscard]] std::string questionnaire_json(const BidsQuestionnaire& questionnaire,
                                             const std::string& language, bool simulated);

/// *_motion.json of one run: the task, the rate, and the recorded device.
/// \param study  unblinded
/// \param body  of the trial's opened `trace-stored` event
[[nodiscard]] std::string motion_json(const DatasetSource& study, const DatasetOptions& options,
                                      const BidsSession& session, const record::TraceBody& body);

/// task-*_channels.json: the frame of positions and forces.
[[nodiscard]] std::string channels_json();

}  // namespace touchtrial::analysis
