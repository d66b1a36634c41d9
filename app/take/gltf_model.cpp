// The arrays of a glTF model, and the looks of bodies. glTF 2.0: registry.khronos.org/glTF.
#include "app/take/gltf_model.h"

#include <algorithm>
#include <cmath>

namespace app {

namespace {

constexpr int kGltfSegments = 32;     // of round bodies
constexpr float kDarker = 1 - 0.45f;  // what a mark leaves of a colour, as in pictures

float linearLight(float c) {
  return c <= 0.04045f ? c / 12.92f : std::pow((c + 0.055f) / 1.055f, 2.4f);
}

// A capsule in its own size, since its ends keep their form; all others are scaled by their node.
render::Geometry gltfGeometry(const render::Instance& look) {
  switch (look.primitive) {
    case render::Primitive::kBox:
      return render::unitBox();
    case render::Primitive::kSphere:
      return render::unitSphere(kGltfSegments);
    case render::Primitive::kCylinder:
      return render::unitCylinder(kGltfSegments);
    case render::Primitive::kMesh:
      return render::geometryOf(*look.mesh);
    case render::Primitive::kCapsule:
      break;
  }
  render::Geometry capsule = render::unitCapsule(kGltfSegments);
  for (render::Vertex& vertex : capsule.vertices) {
    for (std::size_t k = 0; k < 3; ++k) vertex.position[k] *= look.size.x();
    vertex.position[1] += vertex.position[3] * look.size.y() / 2;
  }
  return capsule;
}

// Whether a triangle is in a marked part: every other octant, of a cylinder every other quarter.
bool isMarked(const render::Geometry& geometry, std::size_t triangle, bool quarters) {
  std::array<float, 3> middle{};
  for (std::size_t corner = 0; corner < 3; ++corner) {
    const render::Vertex& vertex = geometry.vertices[geometry.indices[triangle + corner]];
    for (std::size_t k = 0; k < 3; ++k) middle[k] += vertex.position[k];
  }
  return middle[0] * middle[2] * (quarters ? 1 : middle[1]) > 0;
}

}  // namespace

int GltfModel::view(const void* bytes, std::size_t count, int target) {
  std::vector<unsigned char>& data = model_.buffers[0].data;
  tinygltf::BufferView view;
  view.buffer = 0;
  view.byteOffset = data.size();
  view.byteLength = count;
  view.target = target;
  const auto* from = static_cast<const unsigned char*>(bytes);
  data.insert(data.end(), from, from + count);
  data.resize((data.size() + 3) / 4 * 4);
  model_.bufferViews.push_back(std::move(view));
  return static_cast<int>(model_.bufferViews.size()) - 1;
}

int GltfModel::add(const std::vector<float>& numbers, int type, bool withBounds) {
  const auto width =
      static_cast<std::size_t>(tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(type)));
  tinygltf::Accessor accessor;
  accessor.bufferView = view(numbers.data(), numbers.size() * sizeof(float), 0);
  accessor.componentType = TINYGLTF_COMPONENT_TYPE_FLOAT;
  accessor.type = type;
  accessor.count = numbers.size() / width;
  for (std::size_t k = 0; withBounds && k < width; ++k) {
    float low = numbers[k], high = low;
    for (std::size_t i = k; i < numbers.size(); i += width) {
      low = std::min(low, numbers[i]);
      high = std::max(high, numbers[i]);
    }
    accessor.minValues.push_back(low);
    accessor.maxValues.push_back(high);
  }
  model_.accessors.push_back(std::move(accessor));
  return static_cast<int>(model_.accessors.size()) - 1;
}

int GltfModel::add(const std::vector<render::Vec3f>& vectors, bool withBounds) {
  std::vector<float> numbers;
  for (const render::Vec3f& v : vectors) numbers.insert(numbers.end(), {v.x(), v.y(), v.z()});
  return add(numbers, TINYGLTF_TYPE_VEC3, withBounds);
}

int GltfModel::add(const std::vector<std::uint32_t>& indices) {
  tinygltf::Accessor accessor;
  accessor.bufferView = view(indices.data(), indices.size() * sizeof(std::uint32_t),
                             TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
  accessor.componentType = TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
  accessor.type = TINYGLTF_TYPE_SCALAR;
  accessor.count = indices.size();
  model_.accessors.push_back(std::move(accessor));
  return static_cast<int>(model_.accessors.size()) - 1;
}

int GltfModel::material(const render::Color& color, bool bothSides) {
  const std::vector<float> key = {color.x(), color.y(), color.z(), color.w(),
                                  bothSides ? 1.f : 0.f};
  const auto [found, isNew] =
      materials_.try_emplace(key, static_cast<int>(model_.materials.size()));
  if (!isNew) return found->second;
  tinygltf::Material material;
  material.pbrMetallicRoughness.baseColorFactor = {linearLight(color.x()), linearLight(color.y()),
                                                   linearLight(color.z()), color.w()};
  material.pbrMetallicRoughness.metallicFactor = 0;
  material.pbrMetallicRoughness.roughnessFactor = 0.7;
  material.doubleSided = bothSides;
  if (color.w() < 1) material.alphaMode = "BLEND";
  model_.materials.push_back(std::move(material));
  return found->second;
}

const GltfModel::Shape& GltfModel::shape(const render::Instance& look) {
  std::vector<float> key = {static_cast<float>(look.primitive), look.marked ? 1.0f : 0.0f};
  if (look.primitive == render::Primitive::kCapsule) {
    key.insert(key.end(), {look.size.x(), look.size.y()});
  }
  const auto [found, isNew] = shapes_.try_emplace({look.mesh.get(), key});
  Shape& shape = found->second;
  if (!isNew) return shape;
  const render::Geometry geometry = gltfGeometry(look);
  std::vector<render::Vec3f> positions, normals;
  for (const render::Vertex& v : geometry.vertices) {
    positions.emplace_back(v.position[0], v.position[1], v.position[2]);
    normals.emplace_back(v.normal[0], v.normal[1], v.normal[2]);
  }
  shape.positions = add(positions, true);
  shape.normals = add(normals);
  std::array<std::vector<std::uint32_t>, 2> parts;
  const bool quarters = look.primitive == render::Primitive::kCylinder;
  for (std::size_t i = 0; i < geometry.indices.size(); i += 3) {
    std::vector<std::uint32_t>& part =
        parts[look.marked && isMarked(geometry, i, quarters) ? 1 : 0];
    part.insert(part.end(), &geometry.indices[i], &geometry.indices[i] + 3);
  }
  for (const std::vector<std::uint32_t>& part : parts) {
    if (!part.empty()) shape.indices.push_back(add(part));
  }
  return shape;
}

int GltfModel::mesh(const render::Instance& look) {
  const Shape& form = shape(look);
  render::Color dark = look.color;
  for (Eigen::Index k = 0; k < 3; ++k) {  // as linear light; sRGB is about its 2.2nd root
    dark[k] *= std::pow(kDarker, 1 / 2.2f);
  }
  const int light = material(look.color, false);
  const auto [found, isNew] =
      meshes_.try_emplace({&form, light}, static_cast<int>(model_.meshes.size()));
  if (!isNew) return found->second;
  tinygltf::Mesh mesh;
  for (std::size_t i = 0; i < form.indices.size(); ++i) {
    tinygltf::Primitive primitive;
    primitive.mode = TINYGLTF_MODE_TRIANGLES;
    primitive.attributes = {{"POSITION", form.positions}, {"NORMAL", form.normals}};
    primitive.indices = form.indices[i];
    primitive.material = i == 0 ? light : material(dark, false);
    mesh.primitives.push_back(std::move(primitive));
  }
  model_.meshes.push_back(std::move(mesh));
  return found->second;
}

}  // namespace app
