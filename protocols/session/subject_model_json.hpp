/// \file Subject files, written. Format: docs/subject-file.md.
#pragma once

#include "protocols/session/subject_model.hpp"

#include <string>

namespace touchtrial::session {

/// A subject file with every key, which parse_subject_model reads back as the same model but for
/// its source. Numbers have all their digits. Indented, ends with a line feed.
[[nodiscard]] std::string subject_model_json(const SubjectModel& model);

}  // namespace touchtrial::session
