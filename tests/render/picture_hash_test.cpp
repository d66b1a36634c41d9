// Every field of a Picture reaches its hash.
#include "render/picture_hash.h"

#include <gtest/gtest.h>

#include <functional>
#include <set>

#include "sample.h"

namespace render {
namespace {

std::shared_ptr<Mesh> triangle() {
  auto mesh = std::make_shared<Mesh>();
  mesh->positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh->normals.assign(3, Vec3f::UnitZ());
  mesh->indices = {0, 1, 2};
  return mesh;
}

Picture filled() {
  Picture picture = samplePicture();
  picture.hud = sampleHud(5);
  picture.instances[0].mesh = triangle();
  Surface surface;
  surface.positions = triangle()->positions;
  surface.indices = triangle()->indices;
  surface.grid.assign(3, Eigen::Vector2f::Zero());
  picture.surfaces = {surface};
  return picture;
}

void changeMesh(Picture& picture, const std::function<void(Mesh&)>& change) {
  const auto mesh = triangle();
  change(*mesh);
  picture.instances[0].mesh = mesh;
}

TEST(PictureHash, IsEqualForEqualPicturesWhateverTheAddressOfTheMesh) {
  EXPECT_EQ(pictureHash(filled()), pictureHash(filled()));
}

TEST(PictureHash, ChangesWithEveryField) {
  using Change = std::function<void(Picture&)>;
  const std::vector<Change> changes = {
      [](Picture&) {},
      [](Picture& p) { p.camera.eye.x() += 1; },
      [](Picture& p) { p.camera.target.z() += 1; },
      [](Picture& p) { p.camera.up.x() += 1; },
      [](Picture& p) { p.camera.fieldOfViewDegrees += 1; },
      [](Picture& p) { p.light.direction.y() += 1; },
      [](Picture& p) { p.light.shadows = false; },
      [](Picture& p) { p.ground.visible = false; },
      [](Picture& p) { p.ground.height += 1; },
      [](Picture& p) { p.ground.spacing += 1; },
      [](Picture& p) { p.ground.color.x() += 0.1f; },
      [](Picture& p) { p.instances.pop_back(); },
      [](Picture& p) { std::swap(p.instances[1], p.instances[2]); },
      [](Picture& p) { p.instances[0].primitive = Primitive::kSphere; },
      [](Picture& p) { p.instances[0].mesh = nullptr; },
      [](Picture& p) { changeMesh(p, [](Mesh& m) { m.positions[1].x() += 1; }); },
      [](Picture& p) { changeMesh(p, [](Mesh& m) { m.normals[1].x() += 1; }); },
      [](Picture& p) { changeMesh(p, [](Mesh& m) { std::swap(m.indices[0], m.indices[1]); }); },
      [](Picture& p) { p.instances[3].size.y() += 1; },
      [](Picture& p) { p.instances[3].position.y() += 1; },
      [](Picture& p) { p.instances[3].orientation.x() += 0.1f; },
      [](Picture& p) { p.instances[3].color.w() -= 0.1f; },
      [](Picture& p) { p.instances[3].marked = true; },
      [](Picture& p) { p.surfaces.clear(); },
      [](Picture& p) { p.surfaces[0].positions[2].x() += 1; },
      [](Picture& p) { std::swap(p.surfaces[0].indices[0], p.surfaces[0].indices[1]); },
      [](Picture& p) { p.surfaces[0].grid[1].y() += 1; },
      [](Picture& p) { p.surfaces[0].edges = true; },
      [](Picture& p) { p.surfaces[0].offset += 1; },
      [](Picture& p) { p.surfaces[0].color.x() += 0.1f; },
      [](Picture& p) { p.surfaces[0].backColor.x() += 0.1f; },
      [](Picture& p) { p.lines[0].from.x() += 1; },
      [](Picture& p) { p.lines[0].to.x() += 1; },
      [](Picture& p) { p.lines[0].color.x() -= 0.1f; },
      [](Picture& p) { p.lines[0].width += 1; },
      [](Picture& p) { p.lines[0].arrow = false; },
      [](Picture& p) { p.lines[0].onTop = false; },
      [](Picture& p) { p.dots[0].at.x() += 1; },
      [](Picture& p) { p.dots[0].color.x() -= 0.1f; },
      [](Picture& p) { p.dots[0].diameter += 1; },
      [](Picture& p) { p.labels[0].at.x() += 1; },
      [](Picture& p) { p.labels[0].text += "a"; },
      [](Picture& p) { p.labels[0].offset.x() += 1; },
      [](Picture& p) { p.labels[0].color.x() += 0.1f; },
      [](Picture& p) { p.labels[0].size += 1; },
      [](Picture& p) { p.hud.visible = false; },
      [](Picture& p) { p.hud.title += "a"; },
      [](Picture& p) { p.hud.rows[0][0] += "a"; },
      [](Picture& p) { p.hud.rows[0][1] += "a"; },
      [](Picture& p) {
        p.hud.bars.push_back({"", "", 0.5f, 0.2f});
      },
      [](Picture& p) {
        p.hud.bars.push_back({"", "", 0.4f, 0.2f});
      },
      [](Picture& p) {
        p.hud.bars.push_back({"", "", 0.5f, 0.3f});
      },
      [](Picture& p) { p.hud.plots[0].title += "a"; },
      [](Picture& p) { p.hud.plots[0].unit += "a"; },
      [](Picture& p) { p.hud.plots[0].length += 1; },
      [](Picture& p) { p.hud.plots[0].logarithmic = true; },
      [](Picture& p) { p.hud.plots[0].curves[0].name += "a"; },
      [](Picture& p) { p.hud.plots[0].curves[0].values[2] += 1; },
      [](Picture& p) { p.hud.plots[0].curves[0].color.y() += 0.1f; },
      [](Picture& p) { p.caption += "a"; },
      [](Picture& p) { p.background.x() -= 0.1f; },
      [](Picture& p) { p.focusCenter.x() += 1; },
      [](Picture& p) { p.focusRadius += 1; },
  };
  std::set<std::uint64_t> hashes;
  for (const Change& change : changes) {
    Picture picture = filled();
    change(picture);
    hashes.insert(pictureHash(picture));
  }
  EXPECT_EQ(hashes.size(), changes.size());
}

TEST(PictureHash, TellsWhereOneTextEndsAndTheNextBegins) {
  Picture a, b;
  a.hud.rows = {{"ab", "c"}};
  b.hud.rows = {{"a", "bc"}};
  EXPECT_NE(pictureHash(a), pictureHash(b));
}

}  // namespace
}  // namespace render
