#include "app/simulated_study.hpp"

#include "app/console.hpp"
#include "app/default_subject.hpp"
#include "core/cipher.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "protocols/design/prepare.hpp"

#include <spdlog/spdlog.h>

namespace touchtrial {

StudyKey simulated_key(const Study& study, const std::filesystem::path& study_file) {
  SeededEntropy entropy(study.seed);
  StudyKey key = make_study_key(study, entropy, true);
  key.pack_folder = simulated_pack_place(study_file).pack;
  return key;
}

void prepare_simulated_pack(const StudyKey& key, bool wait) {
  const PrepareReport prepared = prepare_pack(key, key.pack_folder, progress_bar("preparing"),
                                              {.statistics = false, .wait = wait});
  for (const std::string& warning : prepared.warnings) spdlog::warn("{}", warning);
}

void refuse_other_key(const std::filesystem::path& path, const StudyKey& key) {
  if (is_there(path) && study_seal(load_study_key(path)) != study_seal(key)) {
    throw StoreError(path.string() +
                     ": exists already; give another --db, or move the old file away");
  }
}

SubjectModel subject_for(const std::filesystem::path& path, const Study& study) {
  SubjectModel subject =
      path.empty() ? parse_subject_model(default_subject_json(), "the default subject model")
                   : load_subject_model(path);
  subject.check_labels(study);
  return subject;
}

}  // namespace touchtrial
