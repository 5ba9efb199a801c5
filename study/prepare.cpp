#include "study/prepare.hpp"

#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/parallel.hpp"
#include "core/strict_json.hpp"
#include "core/text.hpp"
#include "engine/image_file.hpp"
#include "engine/rendering/gains.hpp"
#include "study/languages.hpp"
#include "study/pack_upkeep.hpp"
#include "study/practice.hpp"
#include "study/prepare_advice.hpp"
#include "study/protocol.hpp"
#include "study/signed_pack.hpp"
#include "study/stimulus_field.hpp"

#include <algorithm>
#include <chrono>
#include <exception>
#include <iterator>
#include <map>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <tuple>

namespace touchtrial::study {
namespace {

std::filesystem::path path_beside(const std::filesystem::path& study_file, const char* suffix) {
  return study_file.parent_path() / (study_file.stem().string() + suffix);
}

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// An image of the study or of its practice. Its fields, one per method, are adjacent in the key.
struct ImageOfStudy {
  StimulusIndex stimulus;  ///< the first field's
  std::filesystem::path path;
  std::size_t first_field = 0;
  std::size_t fields = 0;
  Digest pixels{};
  std::vector<std::string> remarks;  ///< engine::remarks_on
  std::int64_t size_px = 0;
  bool is_done = false;
  std::exception_ptr failure;
};

/// Results that depend on all fields together.
struct MeasuredFields {
  engine::StudyGains gains;              ///< of the study's fields
  std::vector<engine::Gains> per_field;  ///< of all fields, practice last
  std::vector<std::string> remarks;      ///< on gains by level
  std::vector<std::uint8_t> flat;        ///< whether a field has no texture to feel
};

bool have_same_image(const StimulusIndex& a, const StimulusIndex& b) {
  return a.class_index == b.class_index && a.exemplar == b.exemplar;
}

std::vector<ImageOfStudy> images_of(const Study& study) {
  std::vector<ImageOfStudy> images;
  std::size_t field_index = 0;
  for (const StimulusIndex& field : presented_fields(study)) {
    if (images.empty() || !have_same_image(images.back().stimulus, field)) {
      const auto& paths = study.class_at(field.class_index).images;
      ImageOfStudy& image = images.emplace_back();
      image.stimulus = field;
      image.path = study.folder / paths[static_cast<std::size_t>(field.exemplar)];
      image.first_field = field_index;
    }
    ++images.back().fields;
    ++field_index;
  }
  return images;
}

std::string fault_of(const Study& study, const ImageOfStudy& image, const std::string& what) {
  return study.source + ": " + place_of_image(study, image.stimulus) + ": " + what;
}

bool is_practice_class(const Study& study, const ImageOfStudy& image) {
  return study.is_practice_class(image.stimulus.class_index);
}

[[noreturn]] void refuse_image(const Study& study, const ImageOfStudy& image,
                               const std::string& what) {
  throw StudyError(fault_of(study, image, what));
}

/// Refuses a practice picture that is smaller than the plane; it may be larger.
void require_large_enough(const Study& study, const ImageOfStudy& image, int width, int height,
                          const PlaneGeometry& plane) {
  if (width >= plane.width_px && height >= plane.height_px) return;
  refuse_image(study, image,
               one_line(image.path.string()) + ": has fewer pixels than the study's plane, " +
                   std::to_string(plane.width_px) + " x " + std::to_string(plane.height_px) +
                   "; use a larger image");
}

/// Reports all unreadable pictures at once, so that one run finds them all.
/// \param faults  messages with the places of pictures; may be empty
void refuse_images(std::vector<std::string> faults) {
  constexpr std::size_t kMaxNamed = 20;
  if (faults.empty()) return;
  const std::size_t count = faults.size();
  faults.resize(std::min(count, kMaxNamed));
  std::string all;
  for (const std::string& fault : faults) all += (all.empty() ? "" : "; ") + fault;
  throw StudyError(count == 1 ? all : all + " (" + std::to_string(count) + " pictures in total)");
}

/// One run of prepare_pack. Stimuli are processed in parallel. Each result is stored at the index
/// of its stimulus, so results do not depend on the order in which threads finish.
class Preparation {
 public:
  Preparation(const StudyKey& key, std::filesystem::path folder, const Progress& progress,
              const PrepareOptions& options)
      : key_(key),
        fields_(key.fields()),
        folder_(std::move(folder)),
        progress_(progress),
        options_(options),
        earlier_(folder_, key),
        images_(images_of(key.study)),
        entries_(fields_.size()),
        is_draft_(fields_.size()),
        is_damaged_(fields_.size()),
        solver_warnings_(fields_.size()),
        prepared_(fields_.size()) {
    for (const engine::PackEntry& entry : earlier_.drafts()) drafts_[entry.code] = entry;
  }

  PrepareReport run() {
    check_images_exist(key_.study);
    if (!key_.practice.empty()) plane_ = plane_of(key_.study);
    // Pictures are hashed before the fields are built, so that sessions are refused if a picture
    // changes in between.
    pictures_ = picture_digests(key_.study);
    provide_fields();
    measure();
    finish();
    advise();
    const auto practice = prepared_.begin() + std::ssize(key_.stimuli);
    report_.stimuli.assign(prepared_.begin(), practice);
    report_.practice.assign(practice, prepared_.end());
    return std::move(report_);
  }

 private:
  void provide_fields() {
    const std::vector<ImageOfStudy*> order = images_by_code();
    const auto provide = [this](ImageOfStudy& image, bool include_large) {
      try {
        provide_fields_of(image, include_large);
      } catch (...) {
        image.failure = std::current_exception();
      }
    };
    in_parallel(0, order.size(), [&](std::size_t i) { provide(*order[i], false); });
    for (ImageOfStudy* image : order) {
      if (!image->is_done && !image->failure) provide(*image, true);
    }
    if (has_draft_folder_) write_drafts();
    refuse_failed_images();
  }

  void refuse_failed_images() const {
    std::vector<std::string> faults;
    for (const ImageOfStudy& image : images_) {
      if (!image.failure) continue;
      try {
        std::rethrow_exception(image.failure);
      } catch (const StudyError& error) {
        faults.emplace_back(error.what());
      }
    }
    refuse_images(std::move(faults));
  }

  /// The images sorted by code. They are processed in this order, so that the times of the files
  /// reveal nothing about the order of classes.
  [[nodiscard]] std::vector<ImageOfStudy*> images_by_code() {
    std::vector<ImageOfStudy*> order;
    for (ImageOfStudy& image : images_) order.push_back(&image);
    std::ranges::sort(order, {}, [this](const ImageOfStudy* image) {
      return std::string_view(fields_[image->first_field].code);
    });
    return order;
  }

  /// \param include_large  whether to process the image now even if it is large
  void provide_fields_of(ImageOfStudy& image, bool include_large) {
    const GreyImage grey = read(image);
    image.size_px = static_cast<std::int64_t>(grey.size());
    if (image.size_px > options_.large_image_px && !include_large) return;
    image.pixels = FieldHasher().add(std::int64_t{grey.width()}).add(grey.samples()).finish();
    std::optional<ExtractedTexture> cache;
    for (std::size_t i = 0; i < image.fields; ++i) {
      provide_field(image.first_field + i, grey, cache);
    }
    image.is_done = true;
  }

  /// Whether a later stimulus of the same image uses the same texture.
  [[nodiscard]] bool is_texture_reused(std::size_t i) const {
    const auto texture_of = [this](const StimulusIndex& index) {
      return without_control(key_.study.methods[static_cast<std::size_t>(index.method)]);
    };
    const StimulusIndex& stimulus = fields_[i].stimulus;
    for (std::size_t later = i + 1; later < fields_.size(); ++later) {
      const StimulusIndex& other = fields_[later].stimulus;
      if (!have_same_image(stimulus, other)) break;
      if (texture_of(other) == texture_of(stimulus)) return true;
    }
    return false;
  }

  [[nodiscard]] GreyImage read(ImageOfStudy& image) const {
    try {
      engine::Picture picture = engine::read_picture(image.path);
      image.remarks = engine::remarks_on(picture.notes);
      if (!is_practice_class(key_.study, image)) return std::move(picture.grey);
      require_large_enough(key_.study, image, picture.grey.width(), picture.grey.height(), plane_);
      return middle_of(picture.grey, plane_);
    } catch (const FileError& error) {
      refuse_image(key_.study, image, error.what());
    }
  }

  void provide_field(std::size_t i, const GreyImage& image,
                     std::optional<ExtractedTexture>& cache) {
    const Clock::time_point start = Clock::now();
    const engine::ExtractionOptions method = method_of(key_.study, fields_[i].stimulus);
    const Digest tag = input_tag(key_.master, image, method, key_.study.rendering);
    const std::string& code = fields_[i].code;
    const auto earlier = earlier_.find(code, tag);
    if (earlier) {
      entries_[i] = earlier->entry;
    } else {
      is_damaged_[i] = earlier_.lists_field(code, tag) ? 1 : 0;
      start_drafts();
      build(i, image, method, tag, cache);
    }
    is_draft_[i] = !earlier || earlier->is_draft ? 1 : 0;
    record_prepared(i, earlier.has_value(), start);
  }

  void build(std::size_t i, const GreyImage& image, const engine::ExtractionOptions& method,
             const Digest& tag, std::optional<ExtractedTexture>& cache) {
    const auto& [code, stimulus] = fields_[i];
    const BuiltField built =
        build_field(image, method, key_.study.rendering, cache, is_texture_reused(i));
    entries_[i] = {
        code, engine::write_field(draft_folder(folder_), code, built.field.view()), tag, {}};
    solver_warnings_[i] = solver_warning(key_.study, stimulus, built);
  }

  void record_prepared(std::size_t i, bool reused, Clock::time_point start) {
    const StimulusIndex& stimulus = fields_[i].stimulus;
    PreparedStimulus& prepared = prepared_[i];
    prepared.class_label = key_.study.class_at(stimulus.class_index).label;
    prepared.exemplar = stimulus.exemplar;
    prepared.method = key_.study.methods[static_cast<std::size_t>(stimulus.method)].label;
    prepared.reused = reused;
    prepared.seconds = seconds_since(start);
    report_progress(i);
  }

  void start_drafts() {
    const std::lock_guard lock(mutex_);
    if (has_draft_folder_) return;
    make_folder(draft_folder(folder_));
    write_drafts();
    has_draft_folder_ = true;
  }

  /// Records finished fields once a second, so that an interrupted run keeps its work.
  void report_progress(std::size_t i) {
    const std::lock_guard lock(mutex_);
    if (is_draft_[i] != 0) drafts_[entries_[i].code] = entries_[i];
    if (has_draft_folder_ && seconds_since(drafts_written_at_) > 1.0) write_drafts();
    ++done_count_;
    if (progress_) progress_(done_count_, static_cast<int>(fields_.size()));
  }

  void write_drafts() {
    engine::PackManifest manifest{key_.study_id, {}};
    for (const auto& [code, entry] : drafts_) manifest.entries.push_back(entry);
    manifest.signature = key_.signer().sign(engine::digest_of(manifest));
    engine::write_manifest(draft_folder(folder_), manifest);
    drafts_written_at_ = Clock::now();
  }

  /// The path of a field before publish() moves the drafts.
  [[nodiscard]] std::filesystem::path field_of(std::size_t i) const {
    return field_path(is_draft_[i] != 0 ? draft_folder(folder_) : folder_, entries_[i].code);
  }

  /// Computes gains, flatness and statistics of all fields.
  void measure() {
    std::vector<engine::MappedField> mapped;
    std::vector<engine::FieldView> views;
    for (std::size_t i = 0; i < entries_.size(); ++i) {
      mapped.push_back(engine::map_field(field_of(i)));
      views.push_back(mapped.back().view());
    }
    choose_gains(views);
    measured_.flat.resize(views.size());
    in_parallel(0, views.size(), [&](std::size_t i) {
      if (!is_large(views[i])) describe(i, views[i]);
    });
    for (std::size_t i = 0; i < views.size(); ++i) {
      if (is_large(views[i])) describe(i, views[i]);
    }
    for (std::size_t i = 0; i < entries_.size(); ++i) {
      PreparedStimulus& prepared = prepared_[i];
      prepared.gains = entries_[i].gains = measured_.per_field[i];
      prepared.bytes = size_of_field(i);
    }
  }

  void choose_gains(std::span<const engine::FieldView> views) {
    choose_study_gains(views.first(key_.stimuli.size()));
    measured_.per_field = measured_.gains.per_field;
    std::ranges::copy(practice_gains(views.subspan(key_.stimuli.size()), measured_.gains.per_field,
                                     key_.study.rendering),
                      std::back_inserter(measured_.per_field));
  }

  void choose_study_gains(std::span<const engine::FieldView> views) {
    if (!key_.study.level) {
      measured_.gains = engine::choose_gains(views, key_.study.rendering);
      return;
    }
    if (!options_.level_gains) throw std::logic_error("prepare_pack: level_gains is not set");
    std::tie(measured_.gains, measured_.remarks) = options_.level_gains(views);
  }

  [[nodiscard]] bool is_large(engine::FieldView field) const noexcept {
    return std::int64_t{field.geometry.height_px} * field.geometry.width_px >
           options_.large_image_px;
  }

  void describe(std::size_t i, engine::FieldView field) {
    measured_.flat[i] = is_flat(field) ? 1 : 0;
    if (!options_.statistics) return;
    prepared_[i].statistics =
        engine::field_statistics(field, measured_.per_field[i], key_.study.rendering);
  }

  [[nodiscard]] std::uintmax_t size_of_field(std::size_t i) const {
    std::error_code error;
    const auto bytes = std::filesystem::file_size(field_of(i), error);
    return error ? 0 : bytes;
  }

  /// Moves the drafts into the pack, the manifest last. Until then the old manifest matches neither
  /// the replaced fields nor the new seal, so no session presents a mixture of old and new fields.
  /// After an interruption, the next run finds the remaining drafts.
  void finish() {
    engine::PackManifest manifest{key_.study_id, entries_};
    sign(manifest, key_, pictures_);
    const bool is_changed =
        !earlier_.has_manifest(manifest) || std::ranges::count(is_draft_, 1) > 0;
    if (is_changed) {
      make_folder(draft_folder(folder_));
      engine::write_manifest(draft_folder(folder_), manifest);
    }
    if (options_.publish_secrets) options_.publish_secrets();
    if (is_changed) publish(manifest);
    remove_leftovers(folder_, manifest);
  }

  void publish(const engine::PackManifest& manifest) {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < entries_.size(); ++i) {
      if (is_draft_[i] != 0) order.push_back(i);
    }
    std::ranges::sort(order, {}, [this](std::size_t i) { return entries_[i].code; });
    for (const std::size_t i : order) {
      rename_file(field_of(i), field_path(folder_, entries_[i].code));
    }
    rename_file(draft_folder(folder_) / "pack.json", folder_ / "pack.json");
    // All fields get the same time, so that it does not reveal a field's picture.
    const auto now = std::filesystem::file_time_type::clock::now();
    for (const engine::PackEntry& entry : manifest.entries) {
      std::error_code ignored;
      std::filesystem::last_write_time(field_path(folder_, entry.code), now, ignored);
    }
  }

  void advise() {
    std::uintmax_t pixels_of_study = 0;
    for (const ImageOfStudy& image : images_) {
      if (is_practice_class(key_.study, image)) continue;
      pixels_of_study += static_cast<std::uintmax_t>(image.size_px);
    }
    report_.skipped = skipped_work(key_.study, pixels_of_study);
    report_.warnings = rendering_warnings(key_.study.rendering, measured_.gains);
    std::ranges::copy(measured_.remarks, std::back_inserter(report_.warnings));
    if (const std::string draft = draft_notice(key_.study.session.language); !draft.empty()) {
      report_.warnings.push_back(
          draft +
          ": have native speakers check every screen, and state this when you report the study");
    }
    if (!earlier_.damage().empty()) {
      report_.warnings.push_back(earlier_.damage() + ": all fields were rebuilt");
    }
    // The warning does not name the fields. Together with a code that `run` named, that would break
    // the blinding.
    if (const auto damaged = std::ranges::count(is_damaged_, 1); damaged > 0) {
      report_.warnings.push_back(counted(damaged, "field") +
                                 " of the pack damaged or missing: rebuilt");
    }
    for (auto& warning : validity_warnings(key_.study)) {
      report_.warnings.push_back(std::move(warning));
    }
    for (auto& warning : key_.study.task->advice(key_.study)) {
      report_.warnings.push_back(std::move(warning));
    }
    if (auto warning = label_warning(key_.study); !warning.empty()) {
      report_.warnings.push_back(std::move(warning));
    }
    std::vector<Digest> pixels;
    for (const ImageOfStudy& image : images_) {
      pixels.push_back(image.pixels);
      for (const std::string& remark : image.remarks) {
        report_.warnings.push_back(one_line(image.path.string() + ": " + remark));
      }
    }
    for (auto& warning : duplicate_warnings(key_.study, pixels)) {
      report_.warnings.push_back(std::move(warning));
    }
    for (std::size_t i = 0; i < fields_.size(); ++i) {
      if (!solver_warnings_[i].empty()) report_.warnings.push_back(solver_warnings_[i]);
      if (measured_.flat[i] == 0) continue;
      report_.warnings.push_back(stimulus_words(key_.study, fields_[i].stimulus) +
                                 ": is flat and cannot be felt; use another picture");
    }
  }

  const StudyKey& key_;
  std::vector<KeyedStimulus> fields_;  ///< of the key, practice last
  std::filesystem::path folder_;
  const Progress& progress_;
  PrepareOptions options_;
  EarlierFields earlier_;
  std::vector<ImageOfStudy> images_;
  PlaneGeometry plane_;  ///< set only if there is practice
  std::vector<Digest> pictures_;
  std::vector<engine::PackEntry> entries_;
  std::vector<std::uint8_t> is_draft_;  ///< whether publish() must move a field
  std::vector<std::uint8_t> is_damaged_;
  std::vector<std::string> solver_warnings_;
  MeasuredFields measured_;
  std::vector<PreparedStimulus> prepared_;
  PrepareReport report_;

  std::mutex mutex_;  ///< guards the members below
  std::map<std::string, engine::PackEntry> drafts_;
  bool has_draft_folder_ = false;
  Clock::time_point drafts_written_at_;
  int done_count_ = 0;
};

}  // namespace

std::filesystem::path PackPlace::station(const std::string& name) const {
  std::filesystem::path file = key;
  file.replace_extension(name.empty() || name == kOnlyStation ? ".station"
                                                              : "." + name + ".station");
  return file;
}

PackPlace default_pack_place(const std::filesystem::path& study_file) {
  return {path_beside(study_file, ".pack"), path_beside(study_file, ".key")};
}

PackPlace simulated_pack_place(const std::filesystem::path& study_file) {
  return {path_beside(study_file, ".sim.pack"), {}};
}

PackPlace pack_place_at(const std::filesystem::path& pack_folder) {
  // The key is beside the folder, however the path is written: "name.pack/", "name.pack/.", ".".
  auto pack = pack_folder.lexically_normal();
  if (!pack.has_filename()) pack = pack.parent_path();
  if (pack == "." || pack.filename() == "..") {
    pack = (std::filesystem::current_path() / pack).lexically_normal();
    if (!pack.has_filename()) pack = pack.parent_path();
  }
  std::filesystem::path key = pack;
  if (key.extension() == ".pack") key.replace_extension();
  key += ".key";
  return {pack, key};
}

std::filesystem::path find_pack(const StudyCodes& codes, const std::filesystem::path& database) {
  const std::filesystem::path& pack = codes.pack_folder;
  if (pack.empty() || path_exists(pack)) return pack;
  for (const std::filesystem::path& folder :
       {database.parent_path(), codes.study.folder, std::filesystem::path()}) {
    std::filesystem::path place = folder / pack.filename();
    try {
      if (path_exists(place) && engine::Pack(place).manifest().study_id == codes.study_id) {
        return place;
      }
    } catch (const FileError&) {
      // There is no pack, or a damaged one. The next folder may have one.
    }
  }
  return pack;
}

void check_images_exist(const Study& study) {
  for (const ImageOfStudy& image : images_of(study)) {
    if (path_exists(image.path)) continue;
    refuse_image(study, image,
                 one_line(image.path.string()) + ": does not exist; correct the path");
  }
  for (const std::string& file : picture_files(study.session)) {
    if (path_exists(study.folder / file)) continue;
    throw StudyError(one_line(study.source + ": /session: the instructions show " +
                              in_quotes(file) + ", which does not exist; correct the path"));
  }
}

PlaneGeometry plane_of(const Study& study) {
  const std::vector<ImageOfStudy> images = images_of(study);
  std::vector<std::pair<int, int>> sizes(images.size());
  std::vector<std::string> faults(images.size());
  const auto note_faults = [&](const auto& read) {
    in_parallel(0, images.size(), [&](std::size_t i) {
      try {
        if (faults[i].empty()) read(i);
      } catch (const FileError& error) {
        faults[i] = error.what();
      }
    });
  };
  note_faults([&](std::size_t i) { sizes[i] = engine::size_of_image(images[i].path); });
  // A header does not show all damage, and one run should name every faulty picture.
  if (std::ranges::any_of(faults, [](const std::string& fault) { return !fault.empty(); })) {
    note_faults([&](std::size_t i) { static_cast<void>(engine::read_grey_image(images[i].path)); });
  }
  const auto words = [](const std::pair<int, int>& size) {
    return std::to_string(size.first) + " x " + std::to_string(size.second) + " pixels";
  };
  for (std::size_t i = 0; i < images.size(); ++i) {
    if (!faults[i].empty()) faults[i] = fault_of(study, images[i], faults[i]);
  }
  std::erase(faults, "");
  refuse_images(std::move(faults));
  const PlaneGeometry plane{study.rendering.pitch_mm, sizes[0].second, sizes[0].first};
  for (std::size_t i = 0; i < images.size(); ++i) {
    if (is_practice_class(study, images[i])) {
      require_large_enough(study, images[i], sizes[i].first, sizes[i].second, plane);
    } else if (sizes[i] != sizes[0]) {
      refuse_image(study, images[i],
                   one_line(images[i].path.string()) + ": has " + words(sizes[i]) + ", but " +
                       one_line(images[0].path.string()) + " has " + words(sizes[0]) +
                       "; all pictures must have the size of the plane: crop them to one size with "
                       "`touchtrial stimuli import`");
    }
  }
  return plane;
}

PrepareReport prepare_pack(const PackLock& lock, const StudyKey& key, const Progress& progress,
                           const PrepareOptions& options) {
  const auto discard_drafts = [&lock] {
    std::error_code ignored;
    std::filesystem::remove_all(draft_folder(lock.folder()), ignored);
  };
  try {
    return Preparation(key, lock.folder(), progress, options).run();
  } catch (const StudyError&) {  // the next run, with a corrected picture, reuses finished fields
    if (options.is_new_key) discard_drafts();
    throw;
  } catch (...) {  // the finished fields may have filled the disk
    discard_drafts();
    throw;
  }
}

PrepareReport prepare_pack(const StudyKey& key, const std::filesystem::path& pack_folder,
                           const Progress& progress, const PrepareOptions& options) {
  return prepare_pack(PackLock(pack_folder), key, progress, options);
}

}  // namespace touchtrial::study
