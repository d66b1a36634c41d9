// A figure's page as PDF or SVG, by cairo and FreeType.
#include "app/figure/vector_page.h"

#include <cairo-ft.h>
#include <cairo-pdf.h>
#include <cairo-svg.h>

#include <memory>
#include <stdexcept>

#include "render/shipped.h"

namespace app {

namespace {

constexpr double kPointsPerMillimetre = 72 / 25.4;
constexpr double kSlant = 0.2, kHalo = 1.0 / 7;  // as a Canvas draws them; of the height of a line

cairo_status_t append(void* bytes, const unsigned char* data, unsigned count) {
  static_cast<std::string*>(bytes)->append(reinterpret_cast<const char*>(data), count);
  return CAIRO_STATUS_SUCCESS;
}

// The shipped font. Never freed: cairo keeps what it made of it until the program ends.
class VectorFont {
 public:
  VectorFont() {
    if (FT_Init_FreeType(&library_) != 0 ||
        FT_New_Face(library_, render::shippedFont().c_str(), 0, &type_) != 0) {
      throw std::runtime_error("cannot read the font " + render::shippedFont());
    }
    face_ = cairo_ft_font_face_create_for_ft_face(type_, FT_LOAD_NO_HINTING);
  }

  cairo_font_face_t* face() const { return face_; }
  // Of the height of a line, from the highest letter to the lowest.
  double emPerLine() const {
    return static_cast<double>(type_->units_per_EM) / (type_->ascender - type_->descender);
  }

 private:
  FT_Library library_ = nullptr;
  FT_Face type_ = nullptr;
  cairo_font_face_t* face_ = nullptr;
};

void setColor(cairo_t* pen, const render::Color& color) {
  cairo_set_source_rgba(pen, color.x(), color.y(), color.z(), color.w());
}

void drawText(cairo_t* pen, const VectorFont& font, const render::Ink& ink) {
  cairo_save(pen);
  cairo_translate(pen, ink.points[0].x(), ink.points[0].y());
  if (ink.upward) cairo_rotate(pen, -1.5707963267948966);
  cairo_set_font_face(pen, font.face());
  const double em = ink.size * font.emPerLine();
  cairo_matrix_t letters;
  cairo_matrix_init(&letters, em, 0, ink.slanted ? -kSlant * em : 0, em, 0, 0);
  cairo_set_font_matrix(pen, &letters);
  if (ink.halo) {
    cairo_move_to(pen, 0, 0);
    cairo_text_path(pen, ink.words.c_str());
    cairo_set_source_rgba(pen, 1, 1, 1, 0.8 * ink.color.w());
    cairo_set_line_width(pen, kHalo * ink.size);
    cairo_stroke(pen);
  }
  setColor(pen, ink.color);
  cairo_move_to(pen, 0, 0);
  cairo_show_text(pen, ink.words.c_str());
  cairo_restore(pen);
}

void drawInk(cairo_t* pen, const VectorFont& font, const render::Ink& ink) {
  if (ink.kind == render::Ink::Kind::kText) return drawText(pen, font, ink);
  setColor(pen, ink.color);
  cairo_new_path(pen);
  if (ink.kind == render::Ink::Kind::kDisc) {
    cairo_arc(pen, ink.points[0].x(), ink.points[0].y(), ink.size, 0, 6.283185307179586);
    cairo_fill(pen);
    return;
  }
  for (const Eigen::Vector2f& point : ink.points) cairo_line_to(pen, point.x(), point.y());
  if (ink.kind == render::Ink::Kind::kArea || ink.closed) cairo_close_path(pen);
  if (ink.kind == render::Ink::Kind::kArea) {
    cairo_fill(pen);
  } else {
    cairo_set_line_width(pen, ink.size);
    cairo_stroke(pen);
  }
}

void drawTile(cairo_t* pen, const render::Page::Tile& tile) {
  const render::Image& image = tile.image;
  cairo_surface_t* surface =
      cairo_image_surface_create(CAIRO_FORMAT_RGB24, image.width, image.height);
  unsigned char* rows = cairo_image_surface_get_data(surface);
  const int stride = cairo_image_surface_get_stride(surface);
  for (int y = 0; y < image.height; ++y) {
    auto* row = reinterpret_cast<std::uint32_t*>(rows + static_cast<std::ptrdiff_t>(y) * stride);
    const std::uint8_t* from =
        &image.rgb[3 * static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width)];
    for (int x = 0; x < image.width; ++x, from += 3) {
      row[x] = static_cast<std::uint32_t>(from[0] << 16 | from[1] << 8 | from[2]);
    }
  }
  cairo_surface_mark_dirty(surface);
  cairo_set_source_surface(pen, surface, tile.x, tile.y);
  cairo_paint(pen);
  cairo_surface_destroy(surface);
}

}  // namespace

std::string vectorPage(const render::Page& page, const std::vector<render::Ink>& ink,
                       double millimetres, const std::string& format) {
  static const VectorFont font;
  const double width = millimetres * kPointsPerMillimetre, scale = width / page.width;
  std::string bytes;
  cairo_surface_t* surface =
      format == "pdf"
          ? cairo_pdf_surface_create_for_stream(append, &bytes, width, scale * page.height)
          : cairo_svg_surface_create_for_stream(append, &bytes, width, scale * page.height);
  if (format == "pdf") {  // no date: the same figure has the same bytes
    cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_CREATE_DATE, "");
  }
  cairo_t* pen = cairo_create(surface);
  cairo_scale(pen, scale, scale);
  setColor(pen, page.background);
  cairo_paint(pen);
  for (const render::Page::Tile& tile : page.tiles) drawTile(pen, tile);
  for (const render::Ink& piece : ink) drawInk(pen, font, piece);
  const cairo_status_t status = cairo_status(pen);
  cairo_destroy(pen);
  cairo_surface_finish(surface);
  cairo_surface_destroy(surface);
  if (status != CAIRO_STATUS_SUCCESS) throw std::runtime_error(cairo_status_to_string(status));
  return bytes;
}

}  // namespace app
