// Steps a world and draws a frame with nothing but what is installed.
#include <physics/world.h>
#include <render/png.h>
#include <render/renderer.h>
#include <scenes/simulation.h>
#include <scenes/view/view.h>

#include <cstdio>
#include <cstdlib>

int main() {
  setenv("DBD_HOME", DATA, 0);
  physics::World world;
  physics::BodyDef ball;
  ball.shape = physics::Sphere{0.5};
  ball.velocity.v = {1, 0, 0};
  const physics::BodyId id = world.add(ball);
  for (int k = 0; k < 60; ++k) world.step();
  std::printf("ball at %.3f m\n", world.bodies().pose[id].x.x());

  scenes::Simulation simulation(scenes::readScene("pyramid"));
  simulation.advance();
  scenes::MotionBounds bounds;
  bounds.include(simulation);
  const render::Picture picture = view(simulation, bounds, {}, {});
  render::Renderer renderer(
      {320, 180, render::Quality::kDraft, std::string(DATA) + "/assets/fonts/DejaVuSans.ttf"});
  render::writePng(renderer.draw(picture), "frame.png");
  std::printf("%d bodies drawn\n", simulation.world().bodyCount() - 1);
}
