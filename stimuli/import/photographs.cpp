#include "stimuli/import/photographs.hpp"

#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/labels.hpp"
#include "core/strict_json.hpp"
#include "core/text.hpp"
#include "engine/image_file.hpp"
#include "engine/image_notes.hpp"
#include "engine/pictures/colour_image.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <regex>
#include <string_view>
#include <system_error>

namespace touchtrial::stimuli {
namespace {

namespace fs = std::filesystem;

/// File extensions of photographs, including unsupported ones, which are refused rather than
/// ignored.
constexpr std::array<std::string_view, 27> kPictureExtensions = {
    ".png", ".jpg", ".jpeg", ".jpe",  ".tif",  ".tiff", ".bmp",  ".pgm", ".ppm",
    ".pnm", ".gif", ".jfif", ".webp", ".heic", ".heif", ".avif", ".jp2", ".jxl",
    ".dng", ".cr2", ".cr3",  ".nef",  ".arw",  ".raw",  ".psd",  ".exr", ".pbm"};

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

std::string lower_case(std::string text) {
  std::ranges::transform(text, text.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  return text;
}

bool is_picture(const fs::path& file) {
  return std::ranges::count(kPictureExtensions, lower_case(file.extension().string())) != 0 ||
         engine::begins_like_image(file);
}

[[noreturn]] void refuse(const fs::path& path, const std::string& problem) {
  throw FileError(one_line(path.string() + ": " + problem));
}

struct Listing {
  std::vector<fs::path> folders;
  std::vector<fs::path> pictures;
  std::vector<std::string> other_files;
};

/// Lists a folder in natural order of the names, which does not depend on the disk.
Listing list_folder(const fs::path& folder) {
  std::error_code error;
  std::vector<fs::path> paths;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    if (!entry->path().filename().string().starts_with('.')) paths.push_back(entry->path());
  }
  if (error) refuse(folder, "cannot be listed (" + error.message() + "); give a readable folder");
  std::ranges::sort(paths, [](const fs::path& a, const fs::path& b) {
    return naturally_before(a.filename().string(), b.filename().string());
  });
  Listing listing;
  for (const fs::path& path : paths) {
    std::error_code ignored;
    if (fs::is_directory(path, ignored)) {
      listing.folders.push_back(path);
    } else if (is_picture(path)) {
      listing.pictures.push_back(path);
    } else {
      listing.other_files.push_back(path.filename().string());
    }
  }
  return listing;
}

struct NaturalOrder {
  bool operator()(const std::string& a, const std::string& b) const {
    return naturally_before(a, b);
  }
};

/// Collects classes and faults of names.
class Classes {
 public:
  explicit Classes(PhotoFolder& folder) : folder_(folder) {}

  void add(const std::string& label, const fs::path& origin, std::vector<fs::path> files) {
    for (const fs::path& file : files) {
      // The fault of the label is reported below.
      const bool has_label_fault = file == origin && !is_utf8(label);
      if (!has_label_fault && !is_utf8(file.filename().string())) {
        add_fault(file, "its name is not UTF-8; rename it");
      }
    }
    const std::string fault = fault_of_label(label);
    const auto [earlier, is_new] = origins_.emplace(skeleton_of(label), origin);
    if (!fault.empty()) {
      const bool is_name = label == origin.stem().string() || label == origin.filename().string();
      add_fault(origin,
                (is_name ? "its name " : "the class in its name, " + in_quotes(label) + ", ") +
                    fault + " and cannot be a label; rename it");
    } else if (!is_new) {
      add_fault(origin, "gives the class \"" + label +
                            "\", which is easily confused with that of " +
                            earlier->second.filename().string() +
                            "; rename one, or put both into a folder named after the class");
    }
    folder_.classes.push_back({label, std::move(files)});
  }
  void add_fault(const fs::path& origin, const std::string& problem) {
    folder_.faults.push_back(one_line(origin.string() + ": " + problem));
  }

 private:
  PhotoFolder& folder_;
  std::map<std::string, fs::path> origins_;
};

void add_folders(const Listing& listing, PhotoFolder& result) {
  Classes classes(result);
  for (const fs::path& folder : listing.folders) {
    Listing class_listing = list_folder(folder);
    for (const fs::path& subfolder : class_listing.folders) {
      classes.add_fault(
          subfolder,
          "is a folder inside a class folder; put all photographs of a class into one folder");
    }
    if (class_listing.pictures.empty() && class_listing.folders.empty()) {
      classes.add_fault(folder, "contains no photograph; add some, or remove the folder");
    }
    for (const std::string& file : class_listing.other_files) {
      result.ignored.push_back(folder.filename().string() + "/" + file);
    }
    classes.add(folder.filename().string(), folder, std::move(class_listing.pictures));
  }
  if (listing.pictures.empty()) return;
  const std::size_t more = listing.pictures.size() - 1;
  classes.add_fault(listing.pictures.front(),
                    "is in a folder with class folders" +
                        (more > 0 ? ", and so are " + std::to_string(more) + " more" : "") +
                        "; give a folder of class folders only, or of photographs only");
}

/// Converts a pattern of names to a regular expression whose only group is the class.
std::regex expression_of(const std::string& names) {
  constexpr std::string_view kClass = "{class}";
  constexpr std::size_t kMaxBytes = 100;
  const std::size_t position = names.find(kClass);
  if (position == std::string::npos || names.find(kClass, position + 1) != std::string::npos ||
      names.size() > kMaxBytes) {
    throw UsageError(
        "stimuli import: --names must contain {class} once, for instance {class}_#, and not be " +
        in_quotes(names));
  }
  std::string expression;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i == position) {
      expression += "(.+?)";
      i += kClass.size() - 1;
    } else if (names[i] == '#') {
      expression += "[0-9]+";
    } else if (names[i] == '*') {
      expression += ".*";
    } else {
      if (std::ispunct(static_cast<unsigned char>(names[i])) != 0) expression += '\\';
      expression += names[i];
    }
  }
  return std::regex(expression);
}

/// Adds the files of an album to the classes in their names, or each to a class named by its stem.
void add_files(const Listing& listing, const std::string& names, PhotoFolder& result) {
  Classes classes(result);
  if (names.empty()) {
    for (const fs::path& file : listing.pictures) classes.add(file.stem().string(), file, {file});
    return;
  }
  const std::regex expression = expression_of(names);
  std::map<std::string, std::vector<fs::path>, NaturalOrder> files;
  for (const fs::path& file : listing.pictures) {
    std::smatch parts;
    const std::string stem = file.stem().string();
    if (std::regex_match(stem, parts, expression)) {
      files[parts[1]].push_back(file);
    } else {
      classes.add_fault(
          file, "its name does not match " + names + "; rename it, or give another --names");
      result.classes.push_back({stem, {file}});
    }
  }
  for (auto& [label, class_files] : files) {
    const fs::path first = class_files.front();
    classes.add(label, first, std::move(class_files));
  }
}

constexpr double kMaxScale = 4.0;
constexpr double kMinScale = 1.0 / 64;

double scale_for(const Photograph& photo, const ImportOptions& options) {
  const std::string name = one_line(photo.path.string());
  const auto pixels_per_mm =
      options.pixels_per_mm_of_files ? photo.notes.pixels_per_mm : options.pixels_per_mm;
  if (!pixels_per_mm && !options.pixels_per_mm_of_files) return 1.0;
  if (!pixels_per_mm) {
    throw FileError(
        name + ": does not state how many pixels per millimetre it has" +
        (photo.notes.camera_dpi
             ? " (" + number_text(std::round(*photo.notes.camera_dpi)) + " dpi is a camera default)"
             : " (72 and 96 dpi are defaults for an unknown resolution)") +
        "; give a number with --pixels-per-mm");
  }
  const double scale = 1.0 / (*pixels_per_mm * options.pitch_mm);
  if (scale > kMaxScale || scale < kMinScale) {
    throw FileError(name + ": " + number_text(*pixels_per_mm) +
                    " pixels per millimetre at a pitch of " + number_text(options.pitch_mm) +
                    " mm would require scaling by " + number_text(scale) +
                    ", outside 1/64 to 4; check --pixels-per-mm and --pitch-mm");
  }
  return scale;
}

int scaled_length(int length_px, double scale) {
  return static_cast<int>(std::max(1L, std::lround(length_px * scale)));
}

}  // namespace

bool naturally_before(const std::string& a, const std::string& b) {
  std::size_t i = 0;
  std::size_t j = 0;
  const auto number = [](const std::string& text, std::size_t& position) {
    const std::size_t start = std::min(text.find_first_not_of('0', position), text.size());
    for (position = start; position < text.size() && is_digit(text[position]);) ++position;
    return std::string_view(text).substr(start, position - start);
  };
  while (i < a.size() && j < b.size()) {
    if (is_digit(a[i]) && is_digit(b[j])) {
      const std::string_view left = number(a, i);
      const std::string_view right = number(b, j);
      if (left.size() != right.size()) return left.size() < right.size();
      if (left != right) return left < right;
    } else if (a[i] != b[j]) {
      return static_cast<unsigned char>(a[i]) < static_cast<unsigned char>(b[j]);
    } else {
      ++i;
      ++j;
    }
  }
  const std::size_t remaining_a = a.size() - i;
  const std::size_t remaining_b = b.size() - j;
  return remaining_a != remaining_b ? remaining_a < remaining_b : a < b;
}

PhotoFolder list_photographs(const fs::path& folder, const std::string& names) {
  std::error_code error;
  if (!fs::is_directory(folder, error)) {
    refuse(folder, fs::exists(folder, error) ? "is not a folder; give the folder of the photographs"
                                             : "does not exist; check the path");
  }
  Listing listing = list_folder(folder);
  PhotoFolder result;
  result.ignored = std::move(listing.other_files);
  if (!names.empty() && !listing.folders.empty()) {
    refuse(folder, "contains folders, whose names are the classes; omit --names");
  }
  if (listing.folders.empty()) {
    add_files(listing, names, result);
  } else {
    add_folders(listing, result);
  }
  if (result.classes.empty()) {
    refuse(folder,
           "contains no photograph; give a folder of PNG, JPEG, TIFF, BMP, GIF or PGM files, or of "
           "class folders with such files");
  }
  return result;
}

Photograph read_photograph(const fs::path& path, const ImportOptions& options) {
  const Bytes file = read_file(path);
  engine::Picture picture = engine::decode_picture(file, path.string(), options.scale);
  Photograph photo;
  photo.path = path;
  photo.notes = std::move(picture.notes);
  photo.image = engine::turn_upright(picture.grey, photo.notes.orientation);
  photo.sha256 = sha256(file);
  photo.pixels_sha256 = FieldHasher()
                            .add(std::int64_t{photo.image.height()})
                            .add(std::int64_t{photo.image.width()})
                            .add(ByteView(photo.image.samples()))
                            .finish();
  photo.height_px = photo.image.height();
  photo.width_px = photo.image.width();
  photo.scale = scale_for(photo, options);
  if (photo.notes.transparent_share > 0.0) {
    const GreyImage opacity =
        engine::turn_upright(engine::opacity_of(file, path.string()), photo.notes.orientation);
    photo.opaque_rectangle =
        opaque_part(opacity, static_cast<int>(std::ceil(options.size_px / photo.scale)));
    if (photo.opaque_rectangle->size_px.width_px == 0) {
      refuse(path, "has no opaque pixel; fill its background and export it again");
    }
    photo.image = crop_image(photo.image, *photo.opaque_rectangle);
  }
  if (photo.scale != 1.0) {
    photo.image = engine::resized(photo.image, scaled_length(photo.image.height(), photo.scale),
                                  scaled_length(photo.image.width(), photo.scale));
  }
  return photo;
}

}  // namespace touchtrial::stimuli
