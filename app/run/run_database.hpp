/// \file The database of a session.
#pragma once

#include "app/run/run_options.hpp"
#include "app/run/run_study.hpp"
#include "protocols/store/study_store.hpp"

namespace touchtrial::app {

/// Opens the database, or makes it with the study's commitment if there is none.
/// \throws StoreError if it is of another study, or one of pilot or simulated sessions is to have
///   others; what StudyStore::open throws
[[nodiscard]] store::StudyStore run_database_for(const RunOptions& options, const RunStudy& study);

}  // namespace touchtrial::app
