#include "stimuli/import/import.hpp"

#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/outputs.hpp"
#include "core/parallel.hpp"
#include "engine/image_file.hpp"
#include "stimuli/default_set.hpp"
#include "stimuli/import/import_checks.hpp"
#include "stimuli/import/import_files.hpp"

#include <algorithm>
#include <map>
#include <mutex>
#include <system_error>

namespace touchtrial::stimuli {
namespace {

namespace fs = std::filesystem;

ImportOptions completed(ImportOptions options) {
  if (options.pictures.empty()) options.pictures = default_pictures_folder(options.study);
  // A trailing slash gives an empty file name, and the parent path is the folder itself.
  if (!options.pictures.has_filename()) options.pictures = options.pictures.parent_path();
  return options;
}

/// A name that suits file names, tables and BIDS labels.
std::string study_name(const fs::path& study) {
  constexpr std::size_t kMaxBytes = 64;
  std::string name = study.stem().string().substr(0, kMaxBytes);
  std::ranges::replace_if(
      name,
      [](char c) {
        return !((c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') ||
                 c == '_' || c == '-');
      },
      '-');
  return name;
}

/// Finds photographs whose bytes or pixels equal those of an earlier one.
class Duplicates {
 public:
  /// \return the fault; empty if none
  std::string fault_of(const Photograph& photo) {
    std::string same = fault_of(photo.sha256, photo.path, "is the same file as ");
    return same.empty() ? fault_of(photo.pixels_sha256, photo.path, "has the same pixels as ")
                        : same;
  }

 private:
  std::string fault_of(const Digest& digest, const fs::path& path, const char* what) {
    const auto [first, is_new] = seen_.emplace(digest, path);
    if (is_new) return {};
    return one_line(path.string() + ": " + what + first->second.string() + "; remove one of them");
  }
  std::map<Digest, fs::path> seen_;
};

/// Whether all of a folder's files are unchanged outputs of this program.
bool are_unchanged_outputs(const fs::path& folder) {
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.is_symlink() || origin_of(entry.path()) != Origin::ours) return false;
  }
  return true;
}

/// Replaces a folder of earlier pictures by new ones, and restores them unless `keep` is called. A
/// folder with foreign or changed files is renamed.
class NewPictures {
 public:
  NewPictures(Draft& draft, const fs::path& place) : place_(place) {
    if (is_there(place_) && !are_unchanged_outputs(place_)) clear_output_place(place_);
    if (is_there(place_)) earlier_ = move_aside(place_);
    if (draft.rename_if_free()) return;
    throw FileError(one_line(place_.string()) + ": another program makes it; try again");
  }
  ~NewPictures() {
    std::error_code ignored;
    if (is_kept_) return;
    fs::remove_all(place_, ignored);
    if (!earlier_.empty()) fs::rename(earlier_, place_, ignored);
  }
  NewPictures(const NewPictures&) = delete;
  NewPictures& operator=(const NewPictures&) = delete;

  /// Called when nothing can fail any more; removes the earlier pictures.
  void keep() noexcept {
    is_kept_ = true;
    std::error_code ignored;
    if (!earlier_.empty()) fs::remove_all(earlier_, ignored);
  }

 private:
  fs::path place_;
  fs::path earlier_;  ///< where they are now; empty if there were none
  bool is_kept_ = false;
};

/// One run: reads each photograph once to check it, and again to cut it.
class Import {
 public:
  Import(const ImportOptions& options, const ImportProgress& progress)
      : options_(completed(options)), progress_(progress) {}

  /// Runs all steps that only read.
  void check_inputs() {
    const PhotoFolder folder = surveyed();
    const auto shares = plan_shares(classes_, small_, options_);
    cut_all({}, shares);
  }

  ImportReport run() {
    check_import(options_);
    PhotoFolder folder = surveyed();
    const auto shares = plan_shares(classes_, small_, options_);
    Draft draft(options_.pictures, Draft::Kind::folder);
    cut_all(draft.path(), shares);
    equalise(draft.path());
    ImportReport result = report(std::move(folder.ignored), shares);
    finish(draft, result.warnings);
    return result;
  }

 private:
  PhotoFolder surveyed() {
    PhotoFolder folder = list_photographs(options_.photographs, options_.names);
    if (folder.faults.empty()) check_classes(folder, options_);
    total_ = 0;
    for (const PhotoClass& one : folder.classes) total_ += 2 * static_cast<int>(one.files.size());
    check_photographs(folder);
    return folder;
  }

  /// Photographs are read on all cores, and checked in order.
  void check_photographs(const PhotoFolder& folder) {
    std::vector<fs::path> files;
    for (const PhotoClass& one : folder.classes) {
      files.insert(files.end(), one.files.begin(), one.files.end());
    }
    std::vector<Photograph> photographs(files.size());
    std::vector<PhotoSize> sizes(files.size());
    std::vector<std::string> faults(files.size());
    all_in_parallel(files.size(), [&](std::size_t i) {
      try {
        photographs[i] = read_photograph(files[i], options_);
      } catch (const FileError& error) {
        faults[i] = error.what();
      }
      sizes[i] = {photographs[i].image.height(), photographs[i].image.width()};
      photographs[i].image = {};
      note_done();
    });
    Duplicates duplicates;
    for (std::size_t i = 0; i < files.size(); ++i) {
      if (!faults[i].empty()) continue;
      faults[i] = duplicates.fault_of(photographs[i]);
      const std::string fault = fault_of_size(photographs[i], sizes[i], options_);
      if (!fault.empty()) small_.push_back(fault);
    }
    std::erase(faults, "");
    faults.insert(faults.begin(), folder.faults.begin(), folder.faults.end());
    if (!faults.empty()) {
      for (const std::string& fault : small_) {
        faults.push_back(fault + "; give a smaller --size, or a larger photograph");
      }
      throw UnusablePhotographs(options_.photographs, std::move(faults));
    }
    std::size_t i = 0;
    for (const PhotoClass& one : folder.classes) {
      SizedClass sized{one.label, one.files, {}};
      for (const fs::path& file : one.files) {
        sized.sizes.push_back(sizes[i]);
        record_.photographs.push_back({name_of(file), std::move(photographs[i]), sizes[i]});
        ++i;
      }
      classes_.push_back(std::move(sized));
    }
  }

  /// The file's name in the manifest.
  [[nodiscard]] std::string name_of(const fs::path& file) const {
    return file.lexically_relative(options_.photographs).generic_string();
  }

  /// A photograph to cut, and the places of its crops in the set.
  struct Cut {
    const SizedClass* of_class;
    fs::path file;
    std::size_t photograph;
    std::size_t first_picture;
    int first_number;  ///< of its class, from 1
    int count;
  };

  /// Cuts all photographs on all cores. A crop's name does not depend on the order of cutting.
  /// \param draft  empty: the crops are only checked
  void cut_all(const fs::path& draft, const std::vector<std::vector<int>>& shares) {
    std::vector<Cut> cuts;
    std::size_t photograph = 0;
    std::size_t pictures = 0;
    for (std::size_t c = 0; c < classes_.size(); ++c) {
      int number = 1;
      for (std::size_t i = 0; i < classes_[c].files.size(); ++i, ++photograph) {
        cuts.push_back(
            {&classes_[c], classes_[c].files[i], photograph, pictures, number, shares[c][i]});
        number += shares[c][i];
        pictures += static_cast<std::size_t>(shares[c][i]);
      }
    }
    record_.pictures.resize(draft.empty() ? 0 : pictures);
    std::vector<std::string> faults(cuts.size());
    all_in_parallel(cuts.size(), [&](std::size_t i) {
      if (cuts[i].count > 0) faults[i] = cut_photograph(draft, cuts[i]);
      note_done();
    });
    std::erase(faults, "");
    if (!faults.empty()) throw UnusablePhotographs(options_.photographs, std::move(faults));
  }

  /// \return what is wrong; empty if nothing is
  std::string cut_photograph(const fs::path& draft, const Cut& wanted) {
    const Photograph photo = read_photograph(wanted.file, options_);
    if (photo.sha256 != record_.photographs[wanted.photograph].photo.sha256) {
      throw FileError(one_line(wanted.file.string()) +
                      ": changed while it was imported; try again");
    }
    // The stream depends on the photograph's name only, independent of other photographs.
    const Digest name = sha256(bytes_of(record_.photographs[wanted.photograph].file));
    RandomStream random(options_.seed, "import crops of " + to_hex(name));
    const PhotoSize size{photo.image.height(), photo.image.width()};
    const auto places = crop_places(size, options_.size_px, wanted.count, random);
    for (std::size_t i = 0; i < places.size(); ++i) {
      const GreyImage crop =
          cut(photo.image, {places[i].x, places[i].y, {options_.size_px, options_.size_px}});
      ImportedPicture picture;
      picture.label = wanted.of_class->label;
      picture.file =
          picture.label + "-" + std::to_string(wanted.first_number + static_cast<int>(i)) + ".png";
      picture.photograph = wanted.photograph;
      picture.place = places[i];
      picture.levels = levels_of(crop);
      if (picture.levels.rms_grey == 0.0) {
        return one_line(photo.path.string()) + ": has only one grey level in the crop at x " +
               std::to_string(places[i].x) + ", y " + std::to_string(places[i].y) +
               ", where nothing can be felt; trim the photograph, or remove it";
      }
      if (draft.empty()) continue;
      put_down(draft, picture, crop);
      record_.pictures[wanted.first_picture + i] = std::move(picture);
    }
    return {};
  }

  static void put_down(const fs::path& draft, ImportedPicture& picture, const GreyImage& pixels) {
    engine::write_png(draft / picture.file, pixels);
    picture.sha256 = sha256_of_file(draft / picture.file);
    picture.pixels_sha256 = sha256(pixels.samples());
  }

  void equalise(const fs::path& draft) {
    if (options_.equalise == LevelEqualising::none) return;
    std::vector<PictureLevels> set;
    for (const ImportedPicture& picture : record_.pictures) set.push_back(picture.levels);
    record_.equal = equal_levels(set, options_.equalise);
    all_in_parallel(record_.pictures.size(), [&](std::size_t i) {
      ImportedPicture& picture = record_.pictures[i];
      const EqualisedPicture result =
          equalised(engine::read_grey_image(draft / picture.file), picture.levels, record_.equal);
      picture.clipped_share = result.clipped_share;
      put_down(draft, picture, result.picture);
    });
  }

  /// Writes the study last; if that fails, the earlier pictures are restored.
  void finish(Draft& draft, const std::vector<std::string>& remarks) {
    write_output(draft.path() / kStimulusManifestFile, import_manifest(record_, options_, remarks));
    const fs::path from = fs::absolute(options_.study).lexically_normal().parent_path();
    const fs::path pictures =
        fs::absolute(options_.pictures).lexically_normal().lexically_relative(from);
    const std::string study = import_study(record_, options_, study_name(options_.study), pictures);
    require_output_place(options_.study);
    NewPictures pictures_in_place(draft, options_.pictures);
    write_output(options_.study, study);
    pictures_in_place.keep();
  }

  ImportReport report(std::vector<std::string> ignored,
                      const std::vector<std::vector<int>>& shares) {
    ImportReport report;
    report.study = options_.study;
    report.pictures = options_.pictures;
    report.ignored = std::move(ignored);
    for (std::size_t c = 0; c < classes_.size(); ++c) {
      report.classes.push_back(summary_of(classes_[c], shares[c], record_, options_));
    }
    report.warnings = import_warnings(report, record_, options_);
    return report;
  }

  /// Called from several threads.
  void note_done() {
    const std::lock_guard lock(mutex_);
    if (progress_) progress_(++done_, total_);
  }

  ImportOptions options_;
  const ImportProgress& progress_;
  std::vector<SizedClass> classes_;
  std::vector<std::string> small_;  ///< faults of photographs smaller than a crop
  ImportRecord record_;
  std::mutex mutex_;  ///< guards done_, and the progress
  int done_ = 0;
  int total_ = 0;
};

}  // namespace

UnusablePhotographs::UnusablePhotographs(const fs::path& folder, std::vector<std::string> faults,
                                         const std::string& remedy)
    : FileError(faults.size() == 1 ? faults.front()
                                   : one_line(folder.string()) + ": has " +
                                         std::to_string(faults.size()) + " faults; " + remedy),
      faults_(std::move(faults)) {}

fs::path default_pictures_folder(const fs::path& study) {
  return study.parent_path() / (study.stem().string() + ".pictures");
}

void try_photographs(const ImportOptions& options, const ImportProgress& progress) {
  Import(options, progress).check_inputs();
}

ImportReport import_photographs(const ImportOptions& options, const ImportProgress& progress) {
  return Import(options, progress).run();
}

}  // namespace touchtrial::stimuli
