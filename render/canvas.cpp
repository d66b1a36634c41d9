// The only file that includes Dear ImGui. Its packaged OpenGL backend cannot start on OSMesa, so
// its draw list is drawn here.
#include "render/canvas.h"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <stdexcept>

#include "render/file_bytes.h"
#include "render/gl.h"
#include "render/marked_text.h"
#include "render/shaders.h"

namespace render {
namespace {

// Latin, Greek, punctuation, super- and subscripts, currency to letterlike, arrows, operators.
constexpr ImWchar kGlyphs[] = {0x0020, 0x007E, 0x00A0, 0x017F, 0x0370, 0x03FF, 0x2010,
                               0x2033, 0x2070, 0x209C, 0x2100, 0x214B, 0x2190, 0x21FF,
                               0x2200, 0x22FF, 0x25A0, 0x25FF, 0};
// Of the height of a line.
constexpr float kScriptSize = 0.72f, kSubscriptDrop = 0.16f, kSuperscriptRise = 0.3f;
constexpr float kSlant = 0.2f, kSlantRoom = 0.06f;
constexpr int kShapesSize = 16;  // any face can serve the shapes; this one is always there

ImVec2 vec(const Pixel& p) { return {p.x(), p.y()}; }

ImU32 pack(const Color& color) {
  return ImGui::ColorConvertFloat4ToU32({color.x(), color.y(), color.z(), color.w()});
}

ImTextureID idOf(GLuint texture) {
  return reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(texture));
}

std::string readFont(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string bytes = bytesOf(stream);
  if (!stream || bytes.size() < 4) throw std::runtime_error("cannot read the font " + file);
  const std::string tag = bytes.substr(0, 4);
  if (tag != std::string("\0\1\0\0", 4) && tag != "true" && tag != "OTTO")
    throw std::runtime_error("not a TrueType font: " + file);
  return bytes;
}

void keep(std::vector<Ink>* all, Ink ink) {
  if (all != nullptr) all->push_back(std::move(ink));
}

// Of a rectangle; its rounding is for the screen.
std::vector<Pixel> cornersOf(const Pixel& from, const Pixel& to) {
  return {from, {to.x(), from.y()}, to, {from.x(), to.y()}};
}

// The font in one size, with the texture of its glyphs.
struct Face {
  ImFontAtlas atlas;
  ImFont* font = nullptr;
  ImTextureID texture = nullptr;

  Face(std::string& bytes, int size) {
    ImFontConfig config;
    config.FontData = bytes.data();
    config.FontDataSize = static_cast<int>(bytes.size());
    config.FontDataOwnedByAtlas = false;
    config.SizePixels = static_cast<float>(size);
    config.GlyphRanges = kGlyphs;
    config.OversampleH = 1;
    config.PixelSnapH = true;
    atlas.Flags = ImFontAtlasFlags_NoMouseCursors | ImFontAtlasFlags_NoBakedLines;
    font = atlas.AddFont(&config);
    unsigned char* pixels = nullptr;
    int width = 0, height = 0;
    atlas.GetTexDataAsAlpha8(&pixels, &width, &height);
    if (pixels == nullptr) throw std::runtime_error("the font cannot be drawn");
    const GLuint name = makeTexture(GL_R8, width, height, GL_LINEAR);
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width, height, GL_RED, GL_UNSIGNED_BYTE, pixels);
    texture = idOf(name);
    atlas.SetTexID(texture);
    atlas.ClearTexData();
  }
};

}  // namespace

struct Canvas::Impl {
  explicit Impl(const std::string& fontFile);

  Face& face(float size);
  void slant(int firstVertex, float baseline);
  void uploadAndDraw() const;

  std::string fontBytes;
  std::map<int, std::unique_ptr<Face>> faces;  // by size in pixels
  ImDrawListSharedData shared;
  ImDrawList list{&shared};
  GLuint program = 0, array = 0, vertices = 0, indices = 0;
  GLint sizeUniform = -1;
  int width = 0, height = 0;
  std::vector<Ink>* ink = nullptr;  // that records; null: nothing does
  bool inHalo = false;              // its copies are no text of their own
};

Canvas::Impl::Impl(const std::string& fontFile) : fontBytes(readFont(fontFile)) {
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  program = makeProgram(kCanvasVertex, kCanvasFragment);
  sizeUniform = glGetUniformLocation(program, "size");
  array = makeVertexArray();
  vertices = makeBuffer();
  indices = makeBuffer();
  glBindVertexArray(array);
  glBindBuffer(GL_ARRAY_BUFFER, vertices);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices);
  const auto attribute = [](GLuint index, GLint size, GLenum type, std::size_t offset) {
    glEnableVertexAttribArray(index);
    glVertexAttribPointer(index, size, type, type == GL_UNSIGNED_BYTE ? GL_TRUE : GL_FALSE,
                          sizeof(ImDrawVert), reinterpret_cast<const void*>(offset));
  };
  attribute(0, 2, GL_FLOAT, offsetof(ImDrawVert, pos));
  attribute(1, 2, GL_FLOAT, offsetof(ImDrawVert, uv));
  attribute(2, 4, GL_UNSIGNED_BYTE, offsetof(ImDrawVert, col));
  shared.TexUvWhitePixel = face(kShapesSize).atlas.TexUvWhitePixel;
  shared.SetCircleTessellationMaxError(0.3f);
  shared.InitialFlags = ImDrawListFlags_AntiAliasedLines | ImDrawListFlags_AntiAliasedFill |
                        ImDrawListFlags_AllowVtxOffset;
}

Face& Canvas::Impl::face(float size) {
  const int pixels = std::clamp(static_cast<int>(std::lround(size)), 6, 256);
  std::unique_ptr<Face>& face = faces[pixels];
  if (!face) face = std::make_unique<Face>(fontBytes, pixels);
  return *face;
}

// Leans what was drawn since `firstVertex` to the right.
void Canvas::Impl::slant(int firstVertex, float baseline) {
  for (int i = firstVertex; i < list.VtxBuffer.Size; ++i) {
    ImVec2& p = list.VtxBuffer[i].pos;
    p.x += kSlant * (baseline - p.y);
  }
}

void Canvas::Impl::uploadAndDraw() const {
  glBindVertexArray(array);
  glBindBuffer(GL_ARRAY_BUFFER, vertices);
  glBufferData(GL_ARRAY_BUFFER, list.VtxBuffer.size_in_bytes(), list.VtxBuffer.Data,
               GL_STREAM_DRAW);
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, list.IdxBuffer.size_in_bytes(), list.IdxBuffer.Data,
               GL_STREAM_DRAW);
  glUseProgram(program);
  glUniform2f(sizeUniform, static_cast<float>(width), static_cast<float>(height));
  glEnable(GL_BLEND);
  for (const ImDrawCmd& command : list.CmdBuffer) {
    if (command.ElemCount == 0) continue;
    const auto texture = reinterpret_cast<std::uintptr_t>(command.TextureId);
    bindTexture(kSourceUnit, GL_TEXTURE_2D, static_cast<GLuint>(texture));
    const std::size_t first = command.IdxOffset * sizeof(ImDrawIdx);
    glDrawElementsBaseVertex(GL_TRIANGLES, static_cast<GLsizei>(command.ElemCount),
                             sizeof(ImDrawIdx) == 2 ? GL_UNSIGNED_SHORT : GL_UNSIGNED_INT,
                             reinterpret_cast<const void*>(first),
                             static_cast<GLint>(command.VtxOffset));
  }
  glDisable(GL_BLEND);
}

Canvas::Canvas(const std::string& fontFile) : impl_(std::make_unique<Impl>(fontFile)) {}

Canvas::~Canvas() = default;

void Canvas::begin(int width, int height) {
  Impl& my = *impl_;
  my.width = width;
  my.height = height;
  my.shared.ClipRectFullscreen = {0, 0, static_cast<float>(width), static_cast<float>(height)};
  my.list._ResetForNewFrame();
  my.list.PushClipRectFullScreen();
  my.list.PushTextureID(my.face(kShapesSize).texture);
}

void Canvas::draw() {
  impl_->list.PopTextureID();
  impl_->list.PopClipRect();
  if (!impl_->list.VtxBuffer.empty()) impl_->uploadAndDraw();
}

void Canvas::record(std::vector<Ink>* ink) { impl_->ink = ink; }

void Canvas::text(const Pixel& at, float size, const Color& color, const std::string& words) {
  Impl& my = *impl_;
  if (!my.inHalo) keep(my.ink, {Ink::Kind::kText, {at}, color, size, words});
  const Face& face = my.face(size);
  my.list.PushTextureID(face.texture);
  my.list.AddText(face.font, face.font->FontSize,
                  {at.x(), std::round(at.y()) - std::round(face.font->Ascent)}, pack(color),
                  words.data(), words.data() + words.size());
  my.list.PopTextureID();
}

void Canvas::textWithHalo(const Pixel& at, float size, const Color& color,
                          const std::string& words) {
  const float reach = std::max(1.0f, std::round(size / 14));
  const Color light(1, 1, 1, 0.45f * color.w());
  impl_->inHalo = true;
  for (const float x : {-reach, 0.0f, reach})
    for (const float y : {-reach, 0.0f, reach})
      if (x != 0 || y != 0) text(at + Pixel(x, y), size, light, words);
  impl_->inHalo = false;
  text(at, size, color, words);
  if (impl_->ink != nullptr) impl_->ink->back().halo = true;
}

float Canvas::widthOf(const std::string& words, float size) {
  const Face& face = impl_->face(size);
  return face.font
      ->CalcTextSizeA(face.font->FontSize, 1e9f, 0, words.data(), words.data() + words.size())
      .x;
}

// Draws the runs of marked text one after the other; returns the width of all. Without a colour it
// only measures.
float Canvas::runs(const Pixel& at, float size, const Color* color, const std::string& words,
                   bool halo) {
  float x = 0;
  for (const TextRun& run : textRuns(words)) {
    const float height = run.level == 0 ? size : std::round(kScriptSize * size);
    const float lower = run.level < 0 ? kSubscriptDrop : run.level > 0 ? -kSuperscriptRise : 0;
    const Pixel start(at.x() + x, at.y() + std::round(lower * size));
    if (color != nullptr) {
      const int first = impl_->list.VtxBuffer.Size;
      halo ? textWithHalo(start, height, *color, run.words)
           : text(start, height, *color, run.words);
      if (run.slanted) impl_->slant(first, start.y());
      if (impl_->ink != nullptr) impl_->ink->back().slanted = run.slanted;
    }
    x += widthOf(run.words, height);
    if (run.slanted) x += std::round(kSlantRoom * size);
  }
  return x;
}

void Canvas::markedText(const Pixel& at, float size, const Color& color, const std::string& words,
                        bool halo) {
  runs(at, size, &color, words, halo);
}

float Canvas::widthOfMarked(const std::string& words, float size) {
  return runs(Pixel::Zero(), size, nullptr, words, false);
}

void Canvas::markedTextUpward(const Pixel& at, float size, const Color& color,
                              const std::string& words) {
  const int first = impl_->list.VtxBuffer.Size;
  const Pixel corner(std::round(at.x()), std::round(at.y()));
  const std::size_t firstInk = impl_->ink != nullptr ? impl_->ink->size() : 0;
  runs(corner, size, &color, words, false);
  for (std::size_t i = firstInk; impl_->ink != nullptr && i < impl_->ink->size(); ++i) {
    Pixel& p = (*impl_->ink)[i].points[0];
    p = {corner.x() + (p.y() - corner.y()), corner.y() - (p.x() - corner.x())};
    (*impl_->ink)[i].upward = true;
  }
  for (int i = first; i < impl_->list.VtxBuffer.Size; ++i) {
    ImVec2& p = impl_->list.VtxBuffer[i].pos;
    p = {corner.x() + (p.y - corner.y()), corner.y() - (p.x - corner.x())};
  }
}

void Canvas::fill(const Pixel& from, const Pixel& to, const Color& color, float rounding) {
  impl_->list.AddRectFilled(vec(from), vec(to), pack(color), rounding);
  keep(impl_->ink, {Ink::Kind::kArea, cornersOf(from, to), color});
}

void Canvas::outline(const Pixel& from, const Pixel& to, const Color& color, float thickness,
                     float rounding) {
  impl_->list.AddRect(vec(from), vec(to), pack(color), rounding, 0, thickness);
  keep(impl_->ink, {Ink::Kind::kCurve, cornersOf(from, to), color, thickness});
  if (impl_->ink != nullptr) impl_->ink->back().closed = true;
}

void Canvas::curve(const std::vector<Pixel>& points, const Color& color, float thickness) {
  if (points.size() < 2) return;
  const auto* const first = reinterpret_cast<const ImVec2*>(points.data());
  impl_->list.AddPolyline(first, static_cast<int>(points.size()), pack(color), 0, thickness);
  keep(impl_->ink, {Ink::Kind::kCurve, points, color, thickness});
}

void Canvas::disc(const Pixel& centre, float radius, const Color& color) {
  impl_->list.AddCircleFilled(vec(centre), radius, pack(color), 24);
  keep(impl_->ink, {Ink::Kind::kDisc, {centre}, color, radius});
}

void Canvas::convexArea(const std::vector<Pixel>& corners, const Color& color) {
  const auto* const first = reinterpret_cast<const ImVec2*>(corners.data());
  impl_->list.AddConvexPolyFilled(first, static_cast<int>(corners.size()), pack(color));
  keep(impl_->ink, {Ink::Kind::kArea, corners, color});
}

}  // namespace render
