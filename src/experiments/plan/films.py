"""Films of reactions, which no other product needs: `films` makes them, MP4 where there is ffmpeg, else WebP."""

import shutil
from collections.abc import Iterator

from experiments.plan.call import Call
from experiments.plan.detection import level_of_detectors
from experiments.plan.files import Files, made_by_jobs
from experiments.plan.products import Product
from experiments.plan.reactions import courses_of


def film_products(files: Files) -> Iterator[Product]:
    """Yield the films of the first robot's walks, where robots have detectors."""
    if not any(level_of_detectors(own) for own in files.owners):
        return
    settings = files.settings
    section = settings.evaluation.films
    ending = "mp4" if shutil.which("ffmpeg") else "webp"
    outs = {case: files.shared / "films" / f"{case}.{ending}" for case in section.joints}
    courses = courses_of(files, section.joints)
    arguments = {
        "settings": section, "robot": settings.robot, "looks": settings.robot.looks, "obstacles": settings.obstacles,
        "courses": courses, "outs": outs,
    }  # fmt: skip
    call = Call("experiments.evaluation.figures.further.films:films", arguments)
    yield Product("films", call, tuple(made_by_jobs(courses)), tuple(map(str, outs.values())))
