#include "app/simulated_study.hpp"

#include "app/console.hpp"
#include "app/default_subject.hpp"
#include "core/cipher.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "protocols/design/prepare.hpp"

#include <spdlog/spdlog.h>

namespace touchtrial::app {

design::StudyKey simulated_key(const design::Study& study,
                               const std::filesystem::path& study_file) {
  SeededEntropy entropy(study.seed);
  design::StudyKey key = design::make_study_key(study, entropy, true);
  key.pack_folder = design::simulated_pack_place(study_file).pack;
  return key;
}

void prepare_simulated_pack(const design::StudyKey& key, bool wait) {
  const design::PrepareReport prepared = design::prepare_pack(
      key, key.pack_folder, progress_bar("preparing"), {.statistics = false, .wait = wait});
  for (const std::string& warning : prepared.warnings) spdlog::warn("{}", warning);
}

void refuse_other_key(const std::filesystem::path& path, const design::StudyKey& key) {
  if (is_there(path) &&
      design::study_seal(design::load_study_key(path)) != design::study_seal(key)) {
    throw StoreError(path.string() +
                     ": exists already; give another --db, or move the old file away");
  }
}

session::SubjectModel subject_for(const std::filesystem::path& path, const design::Study& study) {
  session::SubjectModel subject =
      path.empty()
          ? session::parse_subject_model(default_subject_json(), "the default subject model")
          : session::load_subject_model(path);
  subject.check_labels(study);
  return subject;
}

}  // namespace touchtrial::app
