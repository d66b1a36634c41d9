// Pictures that are drawn side by side, in processes of their own.
#pragma once

#include <functional>
#include <vector>

namespace app {

// Calls draw(frame) for each of `frames`, begun in this order, in as many processes as asked. Each
// of them begins with what the caller has, keeps what its calls make, and hands over nothing but
// the files it writes. `done` is called here after every frame. False: a signal came before the
// end. Throws what draw() threw, and is to be called when Crew's constructor is.
bool drawApart(const std::vector<int>& frames, int workers,
               const std::function<void(int frame)>& draw, const std::function<void()>& done = {});

}  // namespace app
