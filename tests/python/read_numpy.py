"""What dbd writes, as NumPy reads it: python3 read_numpy.py DBD FOLDER, with Debian's python3-numpy."""
import subprocess
import sys

import numpy as np


def motion(path):
    m = np.load(path)
    ball = m["pose"][:, m["names"] == b"chain.19", :3]
    return ball.squeeze()


def metrics(path):
    table = np.genfromtxt(path, delimiter=",", names=True)
    return table["time"], table["total"]


def study(path):
    points = np.genfromtxt(path, delimiter=",", names=True, dtype=None, encoding="utf-8")
    return points["method"], points["error"]


def main(dbd, folder):
    def run(*arguments):
        subprocess.run([dbd, *arguments], cwd=folder, check=True, stdout=subprocess.DEVNULL)

    run("simulate", "chain", "--set", "duration=0.5", "--motion", "chain.npz",
        "--metrics", "metrics.csv", "--progress", "none")
    run("study", "accuracy", "bounce", "--quick", "--progress", "none", "-o", "study")
    ball = motion(folder + "/chain.npz")
    assert ball.shape == (31, 3), ball.shape
    assert np.isfinite(ball).all() and ball[-1, 1] < ball[0, 1]
    time, energy = metrics(folder + "/metrics.csv")
    assert np.allclose(time, np.arange(31) / 60) and np.isfinite(energy).all()
    method, error = study(folder + "/study/points.csv")
    assert len(method) > 3 and (error[np.isfinite(error)] >= 0).all()
    print(f"{len(ball)} frames, {len(time)} rows of metrics, {len(method)} points of a study")


if __name__ == "__main__":
    main(*sys.argv[1:])
