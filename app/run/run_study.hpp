/// \file The study of a session: its key and its pack, held against each other and the study file.
#pragma once

#include "app/run/run_options.hpp"
#include "engine/pack/pack.hpp"
#include "protocols/design/study_key.hpp"

namespace touchtrial::app {

struct RunStudy {
  design::StudyKey key;
  engine::Pack pack;
};

/// Loads what `prepare` made: `--key`, else the key beside the database, else that beside the pack.
/// For a simulated participant the simulated study stands in if nothing was prepared; its key is
/// laid beside the database.
/// \throws StudyError if the study file has changed since it was prepared
/// \throws FileError if pack or key is missing or damaged, with the remedy
[[nodiscard]] RunStudy run_study_for(const RunOptions& options);

}  // namespace touchtrial::app
