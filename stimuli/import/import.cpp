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

ImportOptions with_default_paths(ImportOptions options) {
  if (options.pictures.empty()) options.pictures = default_pictures_folder(options.study);
  // A trailing slash gives an empty file name, and the parent path is the folder itself.
  if (!options.pictures.has_filename()) options.pictures = options.pictures.parent_path();
  return options;
}

/// A name valid in file names, tables and BIDS labels.
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

/// Finds photographs that have the same bytes or pixels as an earlier one.
class Duplicates {
 public:
  /// \return the fault; empty if there is none
  std::string fault_of(const Photograph& photo) {
    std::string fault = fault_of(photo.sha256, photo.path, "is the same file as ");
    return fault.empty() ? fault_of(photo.pixels_sha256, photo.path, "has the same pixels as ")
                         : fault;
  }

 private:
  std::string fault_of(const Digest& digest, const fs::path& path, const char* relation) {
    const auto [first, is_new] = paths_by_digest_.emplace(digest, path);
    if (is_new) return {};
    return one_line(path.string() + ": " + relation + first->second.string() +
                    "; remove one of them");
  }
  std::map<Digest, fs::path> paths_by_digest_;
};

/// Whether all of a folder's files are unchanged outputs of this program.
bool are_unchanged_outputs(const fs::path& folder) {
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.is_symlink() || origin_of(entry.path()) != Origin::ours) return false;
  }
  return true;
}

/// Replaces a folder of earlier pictures, and restores them in the destructor unless `commit` was
/// called. Renames a folder with foreign or changed files.
class PictureReplacement {
 public:
  PictureReplacement(Draft& draft, const fs::path& path) : path_(path) {
    if (path_exists(path_) && !are_unchanged_outputs(path_)) clear_output_path(path_);
    if (path_exists(path_)) earlier_path_ = move_aside(path_);
    if (draft.rename_if_free()) return;
    throw FileError(one_line(path_.string()) + ": is being created by another program; try again");
  }
  ~PictureReplacement() {
    std::error_code ignored;
    if (is_committed_) return;
    fs::remove_all(path_, ignored);
    if (!earlier_path_.empty()) fs::rename(earlier_path_, path_, ignored);
  }
  PictureReplacement(const PictureReplacement&) = delete;
  PictureReplacement& operator=(const PictureReplacement&) = delete;

  /// Keeps the new pictures and removes the earlier ones.
  void commit() noexcept {
    is_committed_ = true;
    std::error_code ignored;
    if (!earlier_path_.empty()) fs::remove_all(earlier_path_, ignored);
  }

 private:
  fs::path path_;
  fs::path earlier_path_;  ///< new path of the earlier pictures; empty if there were none
  bool is_committed_ = false;
};

/// One import. Reads each photograph once to check it, and again to crop it.
class Import {
 public:
  Import(const ImportOptions& options, const ImportProgress& progress)
      : options_(with_default_paths(options)), progress_(progress) {}

  /// Runs all steps that do not write.
  void check_inputs() {
    const PhotoFolder folder = survey();
    const auto crop_counts = plan_crops(classes_, size_faults_, options_);
    crop_all({}, crop_counts);
  }

  ImportReport run() {
    check_import(options_);
    PhotoFolder folder = survey();
    const auto crop_counts = plan_crops(classes_, size_faults_, options_);
    Draft draft(options_.pictures, Draft::Kind::folder);
    crop_all(draft.path(), crop_counts);
    equalise(draft.path());
    ImportReport result = report(std::move(folder.ignored), crop_counts);
    finish(draft, result.warnings);
    return result;
  }

 private:
  PhotoFolder survey() {
    PhotoFolder folder = list_photographs(options_.photographs, options_.names);
    if (folder.faults.empty()) check_classes(folder, options_);
    total_ = 0;
    for (const PhotoClass& photo_class : folder.classes)
      total_ += 2 * static_cast<int>(photo_class.files.size());
    check_photographs(folder);
    return folder;
  }

  /// Reads photographs on all cores and checks them in order.
  void check_photographs(const PhotoFolder& folder) {
    std::vector<fs::path> files;
    for (const PhotoClass& photo_class : folder.classes) {
      files.insert(files.end(), photo_class.files.begin(), photo_class.files.end());
    }
    std::vector<Photograph> photographs(files.size());
    std::vector<PhotoSize> sizes(files.size());
    std::vector<std::string> faults(files.size());
    run_all_in_parallel(files.size(), [&](std::size_t i) {
      try {
        photographs[i] = read_photograph(files[i], options_);
      } catch (const FileError& error) {
        faults[i] = error.what();
      }
      sizes[i] = {photographs[i].image.height(), photographs[i].image.width()};
      photographs[i].image = {};
      report_progress();
    });
    Duplicates duplicates;
    for (std::size_t i = 0; i < files.size(); ++i) {
      if (!faults[i].empty()) continue;
      faults[i] = duplicates.fault_of(photographs[i]);
      const std::string fault = fault_of_size(photographs[i], sizes[i], options_);
      if (!fault.empty()) size_faults_.push_back(fault);
    }
    std::erase(faults, "");
    faults.insert(faults.begin(), folder.faults.begin(), folder.faults.end());
    if (!faults.empty()) {
      for (const std::string& fault : size_faults_) {
        faults.push_back(fault + "; give a smaller --size, or a larger photograph");
      }
      throw UnusablePhotographs(options_.photographs, std::move(faults));
    }
    std::size_t i = 0;
    for (const PhotoClass& photo_class : folder.classes) {
      SizedClass sized_class{photo_class.label, photo_class.files, {}};
      for (const fs::path& file : photo_class.files) {
        sized_class.sizes.push_back(sizes[i]);
        record_.photographs.push_back({name_of(file), std::move(photographs[i]), sizes[i]});
        ++i;
      }
      classes_.push_back(std::move(sized_class));
    }
  }

  /// The file's name in the manifest.
  [[nodiscard]] std::string name_of(const fs::path& file) const {
    return file.lexically_relative(options_.photographs).generic_string();
  }

  /// A photograph to crop, and the indices of its crops.
  struct CropJob {
    const SizedClass* photo_class;
    fs::path file;
    std::size_t photograph;
    std::size_t first_picture;
    int first_number;  ///< within the class, from 1
    int count;
  };

  /// Crops all photographs on all cores. Names of crops do not depend on the order.
  /// \param draft  empty: only checks the crops
  void crop_all(const fs::path& draft, const std::vector<std::vector<int>>& crop_counts) {
    std::vector<CropJob> jobs;
    std::size_t photograph = 0;
    std::size_t pictures = 0;
    for (std::size_t c = 0; c < classes_.size(); ++c) {
      int number = 1;
      for (std::size_t i = 0; i < classes_[c].files.size(); ++i, ++photograph) {
        jobs.push_back(
            {&classes_[c], classes_[c].files[i], photograph, pictures, number, crop_counts[c][i]});
        number += crop_counts[c][i];
        pictures += static_cast<std::size_t>(crop_counts[c][i]);
      }
    }
    record_.pictures.resize(draft.empty() ? 0 : pictures);
    std::vector<std::string> faults(jobs.size());
    run_all_in_parallel(jobs.size(), [&](std::size_t i) {
      if (jobs[i].count > 0) faults[i] = crop_photograph(draft, jobs[i]);
      report_progress();
    });
    std::erase(faults, "");
    if (!faults.empty()) throw UnusablePhotographs(options_.photographs, std::move(faults));
  }

  /// \return the fault, or empty
  std::string crop_photograph(const fs::path& draft, const CropJob& job) {
    const Photograph photo = read_photograph(job.file, options_);
    if (photo.sha256 != record_.photographs[job.photograph].photo.sha256) {
      throw FileError(one_line(job.file.string()) + ": changed while it was imported; try again");
    }
    // The stream depends only on the photograph's name, not on other photographs.
    const Digest name = sha256(bytes_of(record_.photographs[job.photograph].file));
    RandomStream random(options_.seed, "import crops of " + to_hex(name));
    const PhotoSize size{photo.image.height(), photo.image.width()};
    const auto positions = crop_positions(size, options_.size_px, job.count, random);
    for (std::size_t i = 0; i < positions.size(); ++i) {
      const GreyImage crop = crop_image(
          photo.image, {positions[i].x, positions[i].y, {options_.size_px, options_.size_px}});
      ImportedPicture picture;
      picture.label = job.photo_class->label;
      picture.file =
          picture.label + "-" + std::to_string(job.first_number + static_cast<int>(i)) + ".png";
      picture.photograph = job.photograph;
      picture.position = positions[i];
      picture.levels = levels_of(crop);
      if (picture.levels.rms_grey == 0.0) {
        return one_line(photo.path.string()) + ": has only one grey level in the crop at x " +
               std::to_string(positions[i].x) + ", y " + std::to_string(positions[i].y) +
               ", where nothing can be felt; trim the photograph, or remove it";
      }
      if (draft.empty()) continue;
      write_picture(draft, picture, crop);
      record_.pictures[job.first_picture + i] = std::move(picture);
    }
    return {};
  }

  static void write_picture(const fs::path& draft, ImportedPicture& picture,
                            const GreyImage& pixels) {
    engine::write_png(draft / picture.file, pixels);
    picture.sha256 = sha256_of_file(draft / picture.file);
    picture.pixels_sha256 = sha256(pixels.samples());
  }

  void equalise(const fs::path& draft) {
    if (options_.equalise == LevelEqualising::none) return;
    std::vector<PictureLevels> picture_levels;
    for (const ImportedPicture& picture : record_.pictures)
      picture_levels.push_back(picture.levels);
    record_.target_levels = equal_levels(picture_levels, options_.equalise);
    run_all_in_parallel(record_.pictures.size(), [&](std::size_t i) {
      ImportedPicture& picture = record_.pictures[i];
      const EqualisedPicture result = equalise_picture(
          engine::read_grey_image(draft / picture.file), picture.levels, record_.target_levels);
      picture.clipped_share = result.clipped_share;
      write_picture(draft, picture, result.picture);
    });
  }

  /// Writes the study last; if that fails, the earlier pictures are restored.
  void finish(Draft& draft, const std::vector<std::string>& remarks) {
    write_output(draft.path() / kStimulusManifestFile, manifest_text(record_, options_, remarks));
    const fs::path study_folder = fs::absolute(options_.study).lexically_normal().parent_path();
    const fs::path pictures =
        fs::absolute(options_.pictures).lexically_normal().lexically_relative(study_folder);
    const std::string study =
        study_file_text(record_, options_, study_name(options_.study), pictures);
    require_output_path(options_.study);
    PictureReplacement replacement(draft, options_.pictures);
    write_output(options_.study, study);
    replacement.commit();
  }

  ImportReport report(std::vector<std::string> ignored,
                      const std::vector<std::vector<int>>& crop_counts) {
    ImportReport report;
    report.study = options_.study;
    report.pictures = options_.pictures;
    report.ignored = std::move(ignored);
    for (std::size_t c = 0; c < classes_.size(); ++c) {
      report.classes.push_back(summary_of(classes_[c], crop_counts[c], record_, options_));
    }
    report.warnings = import_warnings(report, record_, options_);
    return report;
  }

  /// Called from several threads.
  void report_progress() {
    const std::lock_guard lock(mutex_);
    if (progress_) progress_(++done_, total_);
  }

  ImportOptions options_;
  const ImportProgress& progress_;
  std::vector<SizedClass> classes_;
  std::vector<std::string> size_faults_;  ///< faults of photographs smaller than a crop
  ImportRecord record_;
  std::mutex mutex_;  ///< guards done_ and progress_
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
