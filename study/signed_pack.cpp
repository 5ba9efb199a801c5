#include "study/signed_pack.hpp"

#include "core/errors.hpp"
#include "core/parallel.hpp"
#include "study/languages.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace touchtrial::study {
namespace {

namespace fs = std::filesystem;

Digest picture_digest(const fs::path& name, const fs::path& file) {
  const Digest content = sha256_of_file(file);
  return FieldHasher()
      .add("touchtrial picture 1")
      .add(name.string())
      .add(ByteView(content))
      .finish();
}

[[noreturn]] void refuse_pack(const fs::path& path, const std::string& what) {
  throw FileError(one_line(path.string() + ": " + what));
}

bool is_intact(const engine::Pack& pack, const std::string& code) {
  try {
    return pack.is_intact(code);
  } catch (const FileError&) {
    return false;
  }
}

}  // namespace

std::vector<fs::path> shown_pictures(const Study& study) {
  std::vector<fs::path> names;
  const auto add = [&names](const fs::path& name) {
    if (std::ranges::count(names, name) == 0) names.push_back(name);
  };
  for (const StudyClass& study_class : study.classes) add(study_class.images.front());
  if (study.trials.practice > 0) {
    for (const StudyClass& study_class : study.practice.classes) add(study_class.images.front());
  }
  for (const std::string& file : picture_files(study.session)) add(file);
  return names;
}

std::vector<Digest> picture_digests(const Study& study) {
  const std::vector<fs::path> names = shown_pictures(study);
  std::vector<Digest> digests(names.size());
  run_all_in_parallel(names.size(), [&](std::size_t i) {
    digests[i] = picture_digest(names[i], study.folder / names[i]);
  });
  std::ranges::sort(digests);
  return digests;
}

void sign(engine::PackManifest& manifest, const StudyKey& key, std::vector<Digest> pictures) {
  manifest.study_id = key.study_id;
  manifest.seal = key.seal;
  manifest.investigator_box = key.investigator_box;
  manifest.pictures = std::move(pictures);
  std::ranges::sort(manifest.entries, {}, &engine::PackEntry::code);
  manifest.signature = key.signer().sign(engine::digest_of(manifest));
}

bool is_signed(const engine::PackManifest& manifest, const PublicKey& investigator) {
  return is_signed_by(investigator, engine::digest_of(manifest), manifest.signature);
}

void require_signed(const engine::Pack& pack, const std::string& study_id, const Digest& seal,
                    const PublicKey& investigator) {
  const engine::PackManifest& manifest = pack.manifest();
  if (manifest.study_id != study_id) {
    refuse_pack(pack.folder(),
                "is the pack of another study; give a pack and a key or station file that were "
                "made together (--pack, --station-file, --key)");
  }
  if (!is_signed(manifest, investigator)) {
    refuse_pack(
        pack.folder() / "pack.json",
        "is not signed by the study's investigator: it was altered, or the key or station file is "
        "another investigator's; copy pack and station file again from the investigator's "
        "machine, or run `touchtrial prepare` there");
  }
  if (manifest.seal != seal) {
    refuse_pack(pack.folder(),
                "was made from another version of this study's file, or is incomplete; run "
                "`touchtrial prepare`, and copy pack and station file together");
  }
  for (const engine::PackEntry& entry : manifest.entries) {
    if (is_intact(pack, entry.code)) continue;
    refuse_pack(pack.folder(),
                "field " + entry.code +
                    " differs from the prepared one; copy the pack again, or run `touchtrial "
                    "prepare`");
  }
}

std::vector<fs::path> require_pictures(const engine::Pack& pack, const Study& study,
                                       std::span<const fs::path> folders) {
  std::vector<fs::path> missing;
  for (const fs::path& name : shown_pictures(study)) {
    const auto folder = std::ranges::find_if(
        folders, [&](const fs::path& candidate) { return path_exists(candidate / name); });
    if (folder == folders.end()) {
      missing.push_back(name);
    } else if (!std::ranges::binary_search(pack.manifest().pictures,
                                           picture_digest(name, *folder / name))) {
      refuse_pack(
          *folder / name,
          "has changed since `touchtrial prepare`, and participants would see it; restore the "
          "picture, or, only if nobody has taken part yet, run `touchtrial prepare` again");
    }
  }
  return missing;
}

void require_complete_pack(const engine::Pack& pack, const StudyCodes& codes) {
  require_signed(pack, codes.study_id, codes.seal, codes.investigator_signature);
  if (pack.manifest().investigator_box != codes.investigator_box) {
    refuse_pack(
        pack.folder(),
        "the key or station file encrypts for another investigator than the one who signed the "
        "pack; copy the station file again from the investigator's machine");
  }
  const std::array<fs::path, 1> folders = {codes.study.folder};
  const std::vector<fs::path> missing = require_pictures(pack, codes.study, folders);
  if (missing.empty()) return;
  refuse_pack(codes.study.folder / missing.front(),
              "does not exist, but participants must see it; copy it here");
}

}  // namespace touchtrial::study
