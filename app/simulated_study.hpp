/// \file A simulated study has secrets of its own, from the study's seed, so that its databases
/// belong together and can be made again.
#pragma once

#include "protocols/design/study_key.hpp"
#include "protocols/session/subject_model.hpp"

#include <filesystem>

namespace touchtrial::app {

/// Its key; the pack that it names lies at simulated_pack_place.
[[nodiscard]] design::StudyKey simulated_key(const design::Study& study,
                                             const std::filesystem::path& study_file);

/// Makes the key's pack as far as it is not there, with a progress bar, and warns where preparing
/// does. \param wait  while another process prepares it \throws as prepare_pack
void prepare_simulated_pack(const design::StudyKey& key, bool wait = false);

/// A key that stayed when its database was removed may serve again; any other may be somebody's
/// only one. \throws StoreError if another key lies there
void refuse_other_key(const std::filesystem::path& path, const design::StudyKey& key);

/// \param path  empty: the subject model that is built in
/// \throws as load_subject_model and SubjectModel::check_labels
[[nodiscard]] session::SubjectModel subject_for(const std::filesystem::path& path,
                                                const design::Study& study);

}  // namespace touchtrial::app
