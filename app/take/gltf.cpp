// A run as glTF 2.0: nodes, tracks of those that move, morph targets of what changes its form.
#include "app/take/gltf.h"

#include <algorithm>
#include <sstream>

#include "app/base/build_info.h"
#include "app/commands/exit_code.h"
#include "app/take/gltf_model.h"

namespace app {

namespace {

class GltfWriter {
 public:
  GltfWriter(const Take& take, const std::string& name)
      : take_(take), arrays_(model_), times_(addTimes()) {
    model_.asset.version = "2.0";
    model_.asset.generator = "dbd " + version();
    tinygltf::Scene scene;
    scene.name = name;
    model_.scenes.push_back(scene);
    model_.defaultScene = 0;
    animation_.name = name;
  }

  std::string write(bool binary) {
    addGround();
    for (std::size_t p = 0; p < take_.parts.size(); ++p) addPart(p);
    for (std::size_t s = 0; s < take_.surfaces.size(); ++s) addSurface(s);
    addCamera();
    if (!animation_.channels.empty()) model_.animations.push_back(std::move(animation_));
    std::ostringstream stream;
    tinygltf::TinyGLTF writer;
    if (!writer.WriteGltfSceneToStream(&model_, stream, !binary, binary)) {
      throw EnvironmentError("glTF: the model could not be written");
    }
    return stream.str();
  }

 private:
  int addTimes() {
    std::vector<float> times;
    for (int frame = 0; frame < take_.frames; ++frame) {
      times.push_back(static_cast<float>(static_cast<double>(frame) / take_.fps));
    }
    return arrays_.add(times, TINYGLTF_TYPE_SCALAR, true);
  }

  int addNode(tinygltf::Node node) {
    const int index = static_cast<int>(model_.nodes.size());
    model_.nodes.push_back(std::move(node));
    model_.scenes[0].nodes.push_back(index);
    return index;
  }

  void addTrack(int node, const char* path, int values) {
    tinygltf::AnimationSampler sampler;
    sampler.input = times_;
    sampler.output = values;
    sampler.interpolation = "LINEAR";
    tinygltf::AnimationChannel channel;
    channel.sampler = static_cast<int>(animation_.samplers.size());
    channel.target_node = node;
    channel.target_path = path;
    animation_.samplers.push_back(std::move(sampler));
    animation_.channels.push_back(std::move(channel));
  }

  // `count` numbers from the `first` on of a part's row, in every frame.
  std::vector<float> columns(std::size_t part, std::size_t first, std::size_t count) const {
    std::vector<float> numbers;
    for (const std::vector<float>& row : take_.poses) {
      const auto at = row.begin() + static_cast<std::ptrdiff_t>(part * Take::kPart + first);
      numbers.insert(numbers.end(), at, at + static_cast<std::ptrdiff_t>(count));
    }
    return numbers;
  }

  static bool changes(const std::vector<float>& numbers, std::size_t width) {
    return !std::equal(numbers.begin() + static_cast<std::ptrdiff_t>(width), numbers.end(),
                       numbers.begin());
  }

  // By how much the node scales its mesh; a capsule has its size in its mesh, so that where its
  // length changes its ends are stretched with it.
  static render::Vec3f scaleOf(const render::Instance& look, float length) {
    if (look.primitive != render::Primitive::kCapsule) {
      return {look.size.x(), length, look.size.z()};
    }
    const float was = look.size.x() + look.size.y(), is = length > 0 ? look.size.x() + length : 0;
    return {1, is / was, 1};
  }

  void addPart(std::size_t p) {
    const TakePart& part = take_.parts[p];
    const std::vector<float> places = columns(p, 0, 3), turns = columns(p, 3, 4),
                             lengths = columns(p, 7, 1);
    std::vector<float> scales;
    for (const float length : lengths) {
      const render::Vec3f scale = scaleOf(part.look, length);
      scales.insert(scales.end(), {scale.x(), scale.y(), scale.z()});
    }
    tinygltf::Node node;
    node.name = part.name.empty() ? "rod." + std::to_string(p) : part.name;
    node.mesh = arrays_.mesh(part.look);
    node.translation.assign(places.begin(), places.begin() + 3);
    node.rotation.assign(turns.begin(), turns.begin() + 4);
    node.scale.assign(scales.begin(), scales.begin() + 3);
    const int index = addNode(std::move(node));
    if (changes(places, 3)) {
      addTrack(index, "translation", arrays_.add(places, TINYGLTF_TYPE_VEC3));
    }
    if (changes(turns, 4)) addTrack(index, "rotation", arrays_.add(turns, TINYGLTF_TYPE_VEC4));
    if (changes(scales, 3)) addTrack(index, "scale", arrays_.add(scales, TINYGLTF_TYPE_VEC3));
  }

  struct Sheet {
    std::vector<render::Vec3f> positions, normals;
  };
  Sheet sheetAt(const TakeSurface& surface, int frame) const {
    const std::vector<float>& row = take_.positions[static_cast<std::size_t>(frame)];
    Sheet sheet;
    for (std::size_t i = 0; i < surface.look.positions.size(); ++i) {
      sheet.positions.emplace_back(&row[3 * (surface.first + i)]);
    }
    sheet.normals = render::smoothNormals(sheet.positions, surface.look.indices);
    for (std::size_t i = 0; i < sheet.positions.size(); ++i) {
      sheet.positions[i] += surface.look.offset * sheet.normals[i];
    }
    return sheet;
  }

  // A morph target for each frame but the first, how far it is from there.
  void addSurface(std::size_t s) {
    const TakeSurface& surface = take_.surfaces[s];
    const Sheet start = sheetAt(surface, 0);
    tinygltf::Primitive primitive;
    primitive.mode = TINYGLTF_MODE_TRIANGLES;
    primitive.attributes = {{"POSITION", arrays_.add(start.positions, true)},
                            {"NORMAL", arrays_.add(start.normals)}};
    primitive.indices = arrays_.add(surface.look.indices);
    primitive.material = arrays_.material(surface.look.color, true);
    for (int frame = 1; frame < take_.frames; ++frame) {
      Sheet now = sheetAt(surface, frame);
      for (std::size_t i = 0; i < now.positions.size(); ++i) {
        now.positions[i] -= start.positions[i];
        now.normals[i] -= start.normals[i];
      }
      primitive.targets.push_back(
          {{"POSITION", arrays_.add(now.positions, true)}, {"NORMAL", arrays_.add(now.normals)}});
    }
    tinygltf::Mesh mesh;
    mesh.name = "surface." + std::to_string(s);
    mesh.weights.assign(primitive.targets.size(), 0.0);
    mesh.primitives.push_back(std::move(primitive));
    tinygltf::Node node;
    node.name = mesh.name;
    node.mesh = static_cast<int>(model_.meshes.size());
    model_.meshes.push_back(std::move(mesh));
    const int index = addNode(std::move(node));
    if (take_.frames > 1) addTrack(index, "weights", weightsOfFrames());
  }

  // In frame k target k has all the weight; between two frames they share it.
  int weightsOfFrames() {
    const auto frames = static_cast<std::size_t>(take_.frames), targets = frames - 1;
    std::vector<float> weights(frames * targets, 0.0f);
    for (std::size_t frame = 1; frame < frames; ++frame) weights[frame * targets + frame - 1] = 1;
    return arrays_.add(weights, TINYGLTF_TYPE_SCALAR);
  }

  void addGround() {
    const render::Ground& ground = take_.stage.ground;
    if (!ground.visible) return;
    const float radius = 6 * take_.stage.focusRadius, x = take_.stage.focusCenter.x(),
                z = take_.stage.focusCenter.z();
    tinygltf::Primitive primitive;
    primitive.mode = TINYGLTF_MODE_TRIANGLES;
    const std::vector<render::Vec3f> corners = {
        {-radius, 0, radius}, {radius, 0, radius}, {radius, 0, -radius}, {-radius, 0, -radius}};
    const std::vector<render::Vec3f> up(4, render::Vec3f::UnitY());
    primitive.attributes = {{"POSITION", arrays_.add(corners, true)}, {"NORMAL", arrays_.add(up)}};
    primitive.indices = arrays_.add(std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3});
    primitive.material = arrays_.material(ground.color, true);
    tinygltf::Mesh mesh;
    mesh.primitives.push_back(std::move(primitive));
    tinygltf::Node node;
    node.name = "the ground";
    node.mesh = static_cast<int>(model_.meshes.size());
    node.translation = {x, ground.height, z};
    model_.meshes.push_back(std::move(mesh));
    addNode(std::move(node));
  }

  // As at the start; a camera of glTF looks along -z of its node.
  void addCamera() {
    const render::Camera& from = take_.stage.camera;
    const render::Vec3f back = (from.eye - from.target).normalized();
    const render::Vec3f hint =
        std::abs(back.y()) > 0.9999f ? -render::Vec3f::UnitZ().eval() : from.up;
    Eigen::Matrix3f axes;
    axes.col(2) = back;
    axes.col(0) = hint.cross(back).normalized();
    axes.col(1) = back.cross(axes.col(0));
    const Eigen::Quaternionf turn(axes);
    tinygltf::Camera camera;
    camera.type = "perspective";
    camera.perspective.yfov = from.fieldOfViewDegrees * M_PI / 180;
    camera.perspective.aspectRatio = 16.0 / 9;
    camera.perspective.znear = 0.01 * (from.eye - from.target).norm();
    camera.perspective.zfar = 100 * (from.eye - from.target).norm();
    model_.cameras.push_back(camera);
    tinygltf::Node node;
    node.name = "camera";
    node.camera = 0;
    node.translation = {from.eye.x(), from.eye.y(), from.eye.z()};
    node.rotation = {turn.x(), turn.y(), turn.z(), turn.w()};
    addNode(std::move(node));
  }

  const Take& take_;
  tinygltf::Model model_;
  GltfModel arrays_;
  tinygltf::Animation animation_;
  int times_ = 0;
};

}  // namespace

std::string gltfFile(const Take& take, const scenes::Scene& scene, bool binary) {
  return GltfWriter(take, scene.name).write(binary);
}

}  // namespace app
