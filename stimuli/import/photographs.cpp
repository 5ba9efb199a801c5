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

/// Endings of photographs, including those that this program cannot read: such files are refused by
/// name rather than ignored.
constexpr std::array<std::string_view, 27> kPictureEndings = {
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
  return std::ranges::count(kPictureEndings, lower_case(file.extension().string())) != 0 ||
         engine::begins_like_image(file);
}

[[noreturn]] void refuse(const fs::path& path, const std::string& what) {
  throw FileError(one_line(path.string() + ": " + what));
}

struct Listing {
  std::vector<fs::path> folders;
  std::vector<fs::path> pictures;
  std::vector<std::string> others;
};

/// Lists a folder in natural order of the names, which does not depend on the disk.
Listing list(const fs::path& folder) {
  std::error_code error;
  std::vector<fs::path> paths;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    if (!entry->path().filename().string().starts_with('.')) paths.push_back(entry->path());
  }
  if (error)
    refuse(folder, "cannot be listed (" + error.message() + "); give a folder you may read");
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
      listing.others.push_back(path.filename().string());
    }
  }
  return listing;
}

struct NaturalOrder {
  bool operator()(const std::string& a, const std::string& b) const {
    return naturally_before(a, b);
  }
};

/// Collects classes, and faults of names.
class Classes {
 public:
  explicit Classes(PhotoFolder& folder) : folder_(folder) {}

  void add(const std::string& label, const fs::path& origin, std::vector<fs::path> files) {
    for (const fs::path& file : files) {
      const bool is_reported = file == origin && !is_utf8(label);
      if (!is_reported && !is_utf8(file.filename().string())) {
        refuse(file, "its name is not UTF-8; rename it");
      }
    }
    const std::string fault = fault_of_label(label);
    const auto [other, is_new] = origins_.emplace(skeleton_of(label), origin);
    if (!fault.empty()) {
      const bool is_name = label == origin.stem().string() || label == origin.filename().string();
      refuse(origin, (is_name ? "its name " : "the class in its name, " + in_quotes(label) + ", ") +
                         fault + " and cannot be a label; rename it");
    } else if (!is_new) {
      refuse(origin, "would be the class \"" + label + "\", which looks like that of " +
                         other->second.filename().string() + "; rename one, or put both into a " +
                         "folder of the class's name");
    }
    folder_.classes.push_back({label, std::move(files)});
  }
  void refuse(const fs::path& origin, const std::string& what) {
    folder_.faults.push_back(one_line(origin.string() + ": " + what));
  }

 private:
  PhotoFolder& folder_;
  std::map<std::string, fs::path> origins_;
};

void add_folders(const Listing& listing, PhotoFolder& result) {
  Classes classes(result);
  for (const fs::path& folder : listing.folders) {
    Listing inside = list(folder);
    for (const fs::path& deeper : inside.folders) {
      classes.refuse(deeper,
                     "is a folder within a class's folder; put the photographs of a class into "
                     "one folder");
    }
    if (inside.pictures.empty() && inside.folders.empty()) {
      classes.refuse(folder, "holds no photograph; add some, or remove the folder");
    }
    for (const std::string& other : inside.others) {
      result.ignored.push_back(folder.filename().string() + "/" + other);
    }
    classes.add(folder.filename().string(), folder, std::move(inside.pictures));
  }
  if (listing.pictures.empty()) return;
  const std::size_t more = listing.pictures.size() - 1;
  classes.refuse(listing.pictures.front(),
                 "lies beside folders" +
                     (more > 0 ? ", and so do " + std::to_string(more) + " more" : "") +
                     "; give a folder of class folders, or one of photographs alone");
}

/// The regular expression of a pattern of names, whose only group is the class.
std::regex expression_of(const std::string& names) {
  constexpr std::string_view kClass = "{class}";
  constexpr std::size_t kMaxBytes = 100;
  const std::size_t at = names.find(kClass);
  if (at == std::string::npos || names.find(kClass, at + 1) != std::string::npos ||
      names.size() > kMaxBytes) {
    throw UsageError(
        "stimuli import: --names must have {class} once, for instance {class}_#, not be " +
        in_quotes(names));
  }
  std::string expression;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i == at) {
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

/// The files of an album by the classes in their names, or their stems.
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
      classes.refuse(
          file, "its name is not of the form " + names + "; rename it, or give another --names");
      result.classes.push_back({stem, {file}});
    }
  }
  for (auto& [label, of_class] : files) {
    const fs::path first = of_class.front();
    classes.add(label, first, std::move(of_class));
  }
}

constexpr double kMaxEnlarged = 4.0;
constexpr double kMaxShrunk = 1.0 / 64;

double scale_for(const Photograph& photo, const ImportOptions& options) {
  const std::string name = one_line(photo.path.string());
  const auto pixels_per_mm =
      options.pixels_per_mm_of_files ? photo.notes.pixels_per_mm : options.pixels_per_mm;
  if (!pixels_per_mm && !options.pixels_per_mm_of_files) return 1.0;
  if (!pixels_per_mm) {
    throw FileError(name + ": does not say how many pixels a millimetre has" +
                    (photo.notes.camera_dpi
                         ? " (" + number_text(std::round(*photo.notes.camera_dpi)) +
                               " dpi is a default of cameras)"
                         : " (72 and 96 dpi are defaults for an unknown resolution)") +
                    "; give --pixels-per-mm a number");
  }
  const double scale = 1.0 / (*pixels_per_mm * options.pitch_mm);
  if (scale > kMaxEnlarged || scale < kMaxShrunk) {
    throw FileError(name + ": " + number_text(*pixels_per_mm) +
                    " pixels a millimetre at a pitch of " + number_text(options.pitch_mm) +
                    " mm means scaling by " + number_text(scale) +
                    ", beyond 1/64 to 4; check --pixels-per-mm and --pitch-mm");
  }
  return scale;
}

int scaled(int length_px, double scale) {
  return static_cast<int>(std::max(1L, std::lround(length_px * scale)));
}

}  // namespace

bool naturally_before(const std::string& a, const std::string& b) {
  std::size_t i = 0;
  std::size_t j = 0;
  const auto number = [](const std::string& text, std::size_t& at) {
    const std::size_t start = std::min(text.find_first_not_of('0', at), text.size());
    for (at = start; at < text.size() && is_digit(text[at]);) ++at;
    return std::string_view(text).substr(start, at - start);
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
  const std::size_t left_over = a.size() - i;
  const std::size_t right_over = b.size() - j;
  return left_over != right_over ? left_over < right_over : a < b;
}

PhotoFolder list_photographs(const fs::path& folder, const std::string& names) {
  std::error_code error;
  if (!fs::is_directory(folder, error)) {
    refuse(folder, fs::exists(folder, error) ? "is not a folder; give the folder of the photographs"
                                             : "does not exist; check the path");
  }
  Listing listing = list(folder);
  PhotoFolder result;
  result.ignored = std::move(listing.others);
  if (!names.empty() && !listing.folders.empty()) {
    refuse(folder, "has folders, whose names are the classes; leave out --names");
  }
  if (listing.folders.empty()) {
    add_files(listing, names, result);
  } else {
    add_folders(listing, result);
  }
  if (result.classes.empty()) {
    refuse(folder,
           "holds no photograph; give a folder of PNG, JPEG, TIFF, BMP, GIF or PGM files, or "
           "of folders of them");
  }
  return result;
}

Photograph read_photograph(const fs::path& path, const ImportOptions& options) {
  const Bytes file = read_file(path);
  engine::Picture picture = engine::decode_picture(file, path.string(), options.scale);
  Photograph photo;
  photo.path = path;
  photo.notes = std::move(picture.notes);
  photo.image = engine::upright(picture.grey, photo.notes.orientation);
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
        engine::upright(engine::opacity_of(file, path.string()), photo.notes.orientation);
    photo.opaque = opaque_part(opacity, static_cast<int>(std::ceil(options.size_px / photo.scale)));
    if (photo.opaque->size_px.width_px == 0) {
      refuse(path, "has no opaque pixel; put it on a background, and export it again");
    }
    photo.image = cut(photo.image, *photo.opaque);
  }
  if (photo.scale != 1.0) {
    photo.image = engine::resized(photo.image, scaled(photo.image.height(), photo.scale),
                                  scaled(photo.image.width(), photo.scale));
  }
  return photo;
}

}  // namespace touchtrial::stimuli
