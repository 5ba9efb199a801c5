#include "analysis/outcomes/recorded_pack.hpp"

#include "core/errors.hpp"

namespace touchtrial::analysis {

std::optional<engine::Pack> pack_of(const record::StudyStore& store, const study::StudyKey& key,
                                    const std::filesystem::path& folder) {
  try {
    engine::Pack pack(folder.empty() ? key.pack_folder : folder);
    if (pack.digest() == store.commitment().pack) return pack;
  } catch (const FileError&) {
    // An unreadable pack counts as missing.
  }
  return std::nullopt;
}

}  // namespace touchtrial::analysis
