#include "analysis/figures/gnuplot.hpp"
#include "analysis/sheet/sheet_rows.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <initializer_list>
#include <system_error>
#include <utility>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

namespace fs = std::filesystem;

// A page has the shape of A4 in landscape. These are its units, in which everything is laid out.
constexpr int kPageWidth = 1830;
constexpr int kPageHeight = 1294;
constexpr int kMargin = 40;
constexpr int kNamesWidth = 236;
constexpr int kGap = 20;
constexpr int kWidestColumn = 386;
constexpr int kPanel = 286;
constexpr int kHeadTop = 130;
constexpr int kPanelTop = 204;
constexpr int kPanelStep = 296;
constexpr int kFiguresTop = kPanelTop + 3 * kPanelStep + 14;
constexpr int kFigureStep = 18;
/// Pixels of a PNG per unit: enough for a projector.
constexpr double kPixelsOfPage = 480.0 / kPanel;
constexpr double kPointsOfPage = 29.7 / 2.54 * 72 / kPageWidth;  ///< points of a PDF per unit
/// Many programs refuse pictures with longer sides.
constexpr std::size_t kMostPagesOfPng = 12;

/// A temporary folder for the pictures that gnuplot reads, which only the owner may open.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::string name = (fs::temp_directory_path() / "touchtrial-sheet-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) {
      throw FileError("temporary folder: cannot be written (" +
                      std::generic_category().message(errno) + "); make room or set TMPDIR");
    }
    path_ = name;
  }
  ~ScratchFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  /// Writes an image with three bytes per pixel.
  /// \return the file
  fs::path add(const engine::ColourImage& image) {
    Bytes bytes;
    bytes.reserve(3 * image.size());
    for (const engine::Rgb& pixel : image.samples()) {
      bytes.insert(bytes.end(), {pixel.red, pixel.green, pixel.blue});
    }
    const fs::path file = path_ / std::to_string(count_++);
    replace_file(file, bytes, FileMode::owner_only);
    return file;
  }

 private:
  fs::path path_;
  int count_ = 0;
};

engine::ColourImage in_colour(const GreyImage& image) {
  engine::ColourImage colours(image.height(), image.width());
  for (std::size_t i = 0; i < image.size(); ++i) {
    const std::uint8_t grey = image.samples()[i];
    colours.samples()[i] = {grey, grey, grey};
  }
  return colours;
}

enum class Weight { plain, bold, code };

/// Collects the labels and pictures of a page as gnuplot's commands.
class Page {
 public:
  /// \param scale  points of a font whose capitals are one unit high
  Page(ScratchFolder& scratch, double scale) : scratch_(scratch), scale_(scale) {}

  void text(double x, double y, double size, const std::string& words,
            const std::string& colour = "#1a1a1a", Weight weight = Weight::plain) {
    const char* font = weight == Weight::code   ? "DejaVu Sans Mono"
                       : weight == Weight::bold ? "DejaVu Sans:Bold"
                                                : "DejaVu Sans";
    labels_ += fmt::format(
        "set label {} at first {}, first {} left font '{},{:.2f}' noenhanced "
        "textcolor rgb '{}' front\n",
        gnuplot_string(words), x, top_ + y, font, size * scale_, colour);
  }

  void rule(double y) {
    labels_ += fmt::format(
        "set arrow from first {0}, first {2} to first {1}, first {2} nohead "
        "lc rgb '#e0e0e0' lw {3:.2f}\n",
        kMargin, kPageWidth - kMargin, top_ + y, scale_);
  }

  /// Centres a picture in a square of kPanel units.
  void picture(double x, double y, const engine::ColourImage& image, int side_px) {
    const double step = static_cast<double>(kPanel) / side_px;
    const double left = x + (kPanel - step * image.width()) / 2 + step / 2;
    const double first = top_ + y + (kPanel - step * image.height()) / 2 + step / 2;
    pictures_ += fmt::format(
        "{}{} binary array=({},{}) format='%uchar' origin=({:.4f},{:.4f}) dx={:.6f} dy={:.6f} "
        "with rgbimage notitle",
        pictures_.empty() ? "plot " : ", \\\n  ", gnuplot_string(scratch_.add(image).string()),
        image.width(), image.height(), left, first, step, step);
  }

  /// Sets the height from which the next texts and pictures count.
  void start_at(double top) { top_ = top; }

  [[nodiscard]] std::string take() {
    return "unset label\nunset arrow\n" + std::exchange(labels_, "") +
           std::exchange(pictures_, "") + "\n";
  }

 private:
  ScratchFolder& scratch_;
  double scale_;
  double top_ = 0.0;
  std::string labels_;
  std::string pictures_;
};

/// The mean advance of a character, as a share of the font's size.
constexpr double kAdvance = 0.72;

/// The size, or a smaller one with which the words fit, down to the smallest that is legible on
/// paper.
double fitting(const std::string& words, double width, double size) {
  constexpr double kSmallest = 9.5;
  const double length = std::max(1.0, static_cast<double>(words.size()));
  return std::clamp(width / (kAdvance * length), std::min(kSmallest, size), size);
}

/// Cuts words to the characters that fit into a width.
std::string shortened(const std::string& words, double width, double size) {
  const auto most = static_cast<std::size_t>(width / (kAdvance * size) + 1e-6);
  if (words.size() <= most) return words;
  std::size_t end = most - 3;
  while (end > 0 && (static_cast<unsigned char>(words[end]) & 0xC0U) == 0x80U) --end;
  return words.substr(0, end) + "...";
}

void add_heading(Page& page, const StimulusSheet& sheet, std::size_t number) {
  page.text(kMargin, 32, 24, shortened(heading_of(sheet), kPageWidth - 250, 24), "#1a1a1a",
            Weight::bold);
  page.text(kPageWidth - 190, 32, 15, fmt::format("sheet {} of {}", number + 1, sheet.lines.size()),
            "#555555");
  page.text(kMargin, 62, 14,
            sheet.protocol + "; " + sheet.rendering + "; seal " + sheet.seal.substr(0, 16),
            "#555555");
  page.text(kMargin, 88, 14, kUnblinds, "#b3261e", Weight::bold);
}

void add_names(Page& page, const std::vector<SheetRow>& rows) {
  const auto name = [&](int row, const char* words, std::initializer_list<const char*> notes) {
    double y = kPanelTop + row * kPanelStep + 12;
    page.text(kMargin, y, 15, words, "#1a1a1a", Weight::bold);
    y += 6;
    for (const char* note : notes) page.text(kMargin, y += 18, 12, note, "#555555");
  };
  name(0, "picture", {"as participants see it"});
  name(1, "texture", {"mid-grey is none;", "contrast times 3;", "the frame is enlarged below"});
  name(2, "lateral force", {"in the frame, as the pack", "holds it; from bright to dark"});
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double y = kFiguresTop + static_cast<double>(i) * kFigureStep;
    page.rule(y - 11);
    page.text(kMargin, y, 11, rows[i].name, "#333333");
  }
}

void add_card(Page& page, const SheetCard& card, double x, double width, int side_px) {
  const double room = width - kGap / 2.0;
  page.text(x, kHeadTop, 18, shortened(title_of(card), room, 18), "#1a1a1a", Weight::bold);
  const std::string origin = card.method + ", " + card.image;
  const double size = fitting(origin, room, 13);
  page.text(x, kHeadTop + 24, size, shortened(origin, room, size), "#333333");
  page.text(x, kHeadTop + 46, 13, card.code, "#b3261e", Weight::code);
  page.text(x + 180, kHeadTop + 46, 11, size_of(card), "#555555");
  page.picture(x, kPanelTop, in_colour(card.picture), side_px);
  page.picture(x, kPanelTop + kPanelStep, card.texture, side_px);
  page.picture(x, kPanelTop + 2 * kPanelStep, card.arrows, side_px);
}

void add_line(Page& page, const StimulusSheet& sheet, std::size_t number) {
  const auto& line = sheet.lines[number];
  const std::vector<SheetRow> rows = figure_rows(line, sheet.level_of);
  const double room = kPageWidth - 2 * kMargin - kNamesWidth + kGap;
  const double width =
      std::min<double>(kWidestColumn, std::floor(room / static_cast<double>(line.size())));
  add_heading(page, sheet, number);
  add_names(page, rows);
  for (std::size_t i = 0; i < line.size(); ++i) {
    const double x = kMargin + kNamesWidth + static_cast<double>(i) * width;
    add_card(page, line[i], x, width, sheet.side_px);
    for (std::size_t row = 0; row < rows.size(); ++row) {
      page.text(x, kFiguresTop + static_cast<double>(row) * kFigureStep, 13,
                rows[row].values[i] + " " + rows[row].unit);
    }
  }
}

std::string canvas(int height) {
  return fmt::format(
      "set encoding utf8\nset lmargin at screen 0\nset rmargin at screen 1\n"
      "set tmargin at screen 1\nset bmargin at screen 0\nunset border\nunset tics\nunset key\n"
      "set xrange [0:{}]\nset yrange [{}:0]\n",
      kPageWidth, height);
}

}  // namespace

void draw_sheet_png(const StimulusSheet& sheet, const fs::path& path) {
  const std::size_t pages = sheet.lines.size();
  if (pages > kMostPagesOfPng) {
    throw UsageError(one_line(path.string()) + ": would be a picture of " + std::to_string(pages) +
                     " pages, more than " + std::to_string(kMostPagesOfPng) +
                     "; choose a name that ends in .pdf or .html");
  }
  ScratchFolder scratch;
  Page page(scratch, kPixelsOfPage);
  for (std::size_t i = 0; i < pages; ++i) {
    page.start_at(static_cast<double>(i) * kPageHeight);
    add_line(page, sheet, i);
  }
  const int height = kPageHeight * static_cast<int>(pages);
  const std::string terminal =
      fmt::format("set terminal pngcairo size {:.0f}, {:.0f} font 'DejaVu Sans,13'\n",
                  kPageWidth * kPixelsOfPage, height * kPixelsOfPage);
  const std::string script = terminal + canvas(height) + page.take();
  draw_with_gnuplot(script, path, FileMode::owner_only);
}

void draw_sheet_pdf(const StimulusSheet& sheet, const fs::path& path) {
  ScratchFolder scratch;
  Page page(scratch, kPointsOfPage);
  std::string script =
      "set terminal pdfcairo size 29.7cm, 21cm font 'DejaVu Sans,6' fontscale 1\n" +
      canvas(kPageHeight);
  for (std::size_t i = 0; i < sheet.lines.size(); ++i) {
    add_line(page, sheet, i);
    script += page.take();
  }
  draw_with_gnuplot(script, path, FileMode::owner_only);
}

}  // namespace touchtrial::analysis
