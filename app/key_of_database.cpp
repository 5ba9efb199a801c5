#include "app/key_of_database.hpp"

#include "analysis/sealed_sessions.hpp"
#include "app/console.hpp"
#include "core/errors.hpp"
#include "protocols/collect/open_study.hpp"
#include "protocols/collect/server_address.hpp"

#include <system_error>

namespace touchtrial::app {

design::StudyKey key_of_database(const store::StudyStore& store,
                                 const std::filesystem::path& database,
                                 const std::filesystem::path& given) {
  if (given.empty() && collect::is_address(database.string())) {
    throw FileError("a study on a server has no key beside it; name the study's key with --key");
  }
  const std::filesystem::path path = key_path_for(database, given);
  std::error_code error;
  if (given.empty() && !std::filesystem::exists(path, error)) {
    throw FileError(path.string() + ": there is no key beside the database; name it with --key");
  }
  design::StudyKey key = design::load_study_key(path);
  try {
    analysis::require_key_of(store, key);
  } catch (const VerificationError& wrong) {
    throw VerificationError(path.string() + ": is not the key of " +
                            one_line(collect::study_name(database.string())) + ": " + wrong.what());
  }
  return key;
}

}  // namespace touchtrial::app
