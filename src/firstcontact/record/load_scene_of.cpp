#include <firstcontact/record/load_scene_of.h>

#include <stdexcept>

#include <firstcontact/record/run.h>

namespace firstcontact {

LoadedScene load_scene_of(const RunHeader& header, ShapeCache& cache) {
  LoadedScene loaded = load_scene(header.scene, cache);
  if (!header.input_digest.empty() && loaded.input_digest != header.input_digest) {
    throw std::invalid_argument(
        "header.input_digest: a mesh or robot file of its scene is not what it was when the run "
        "was made; restore the file, or make the run again");
  }
  return loaded;
}

}  // namespace firstcontact
