/// \file The recovery sheet of a key as a document, to be printed.
#pragma once

#include "analysis/page/document.hpp"
#include "protocols/design/study_key.hpp"

namespace touchtrial::analysis {

/// What the sheet is good for, its lines (design::recovery_lines), and how to make the key of them.
/// Whoever reads it can open every session of the study.
/// \throws UsageError if the key is a simulated study's, which follows from the study file, or has
///   more lines than a sheet holds
[[nodiscard]] Document recovery_document(const design::StudyKey& key);

}  // namespace touchtrial::analysis
