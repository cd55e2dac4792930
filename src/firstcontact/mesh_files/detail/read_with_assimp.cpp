#include <firstcontact/mesh_files/detail/read_with_assimp.h>

#include <cmath>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include <assimp/BaseImporter.h>
#include <assimp/config.h>
#include <assimp/importerdesc.h>
#include <assimp/scene.h>
#include <Eigen/Geometry>
#include <assimp/Importer.hpp>

#include <firstcontact/mesh_files/detail/check_assimp_input.h>
#include <firstcontact/mesh_files/detail/mesh_builder.h>
#include <firstcontact/text/parse_error.h>

namespace firstcontact::detail {
namespace {

/// Leaves only the reader of one format, so that the content cannot choose another.
void keep_reader(Assimp::Importer& importer, std::string_view extension) {
  for (std::size_t i = importer.GetImporterCount(); i-- > 0;) {
    const std::string known = " " + std::string(importer.GetImporterInfo(i)->mFileExtensions) + " ";
    if (known.find(" " + std::string(extension) + " ") == std::string::npos) {
      std::unique_ptr<Assimp::BaseImporter> reader(importer.GetImporter(i));
      importer.UnregisterLoader(reader.get());
    }
  }
}

Eigen::Affine3d to_eigen(const aiMatrix4x4& m) {
  Eigen::Affine3d X;
  X.matrix() << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4, 0, 0, 0, 1;
  return X;
}

void add_mesh(const std::string& path, const aiMesh& part, const Eigen::Affine3d& X,
              MeshBuilder& mesh) {
  const auto base = static_cast<std::int64_t>(mesh.vertex_count());
  for (unsigned i = 0; i < part.mNumVertices; ++i) {
    const aiVector3D& v = part.mVertices[i];
    const Eigen::Vector3d p = X * Eigen::Vector3d(v.x, v.y, v.z);
    if (!p.allFinite() || !mesh.add_vertex(p)) {
      throw ParseError(
          path, "expected finite coordinates of vertex " + std::to_string(mesh.vertex_count()));
    }
  }
  for (unsigned i = 0; i < part.mNumFaces; ++i) {
    const aiFace& face = part.mFaces[i];
    if (face.mNumIndices < 3) {
      continue;  // Lines and points are drawings here, not parts of the body.
    }
    mesh.begin_polygon(i);
    for (unsigned k = 0; k < face.mNumIndices; ++k) {
      if (face.mIndices[k] >= part.mNumVertices || !mesh.add_corner(base + face.mIndices[k])) {
        throw ParseError(path,
                         "vertex index " + std::to_string(face.mIndices[k]) + " is out of range");
      }
    }
    mesh.end_polygon();
  }
}

void add_scene(const std::string& path, const aiScene& scene, MeshBuilder& mesh) {
  std::vector<std::pair<const aiNode*, Eigen::Affine3d>> open;
  open.emplace_back(scene.mRootNode, Eigen::Affine3d::Identity());
  while (!open.empty()) {
    const auto [node, X_parent] = open.back();
    open.pop_back();
    const Eigen::Affine3d X = X_parent * to_eigen(node->mTransformation);
    for (unsigned i = 0; i < node->mNumMeshes; ++i) {
      add_mesh(path, *scene.mMeshes[node->mMeshes[i]], X, mesh);
    }
    for (unsigned i = node->mNumChildren; i-- > 0;) {
      open.emplace_back(node->mChildren[i], X);
    }
  }
}

}  // namespace

Mesh read_with_assimp(const std::string& path, std::string_view bytes, std::string_view extension) {
  if (extension == "glb") {
    check_glb_chunks(path, bytes);
  } else if (extension == "dae") {
    check_dae_numbers(path, bytes);
  }
  Assimp::Importer importer;
  keep_reader(importer, extension);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  const aiScene* scene = importer.ReadFile(path, 0);
  if (scene == nullptr || scene->mRootNode == nullptr) {
    throw ParseError(path, "expected a readable " + std::string(extension) +
                               " file: " + importer.GetErrorString());
  }
  MeshBuilder mesh;
  add_scene(path, *scene, mesh);
  if (mesh.is_empty()) {
    throw ParseError(path, "expected at least one face, found none");
  }
  return mesh.finish();
}

}  // namespace firstcontact::detail
