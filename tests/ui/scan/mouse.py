"""What the mouse does to the page Scan, and what is seen there."""

import numpy as np
from PySide6.QtCore import QPointF, Qt
from PySide6.QtTest import QTest


def press(button):
    assert button.isEnabled()
    QTest.mouseClick(button, Qt.MouseButton.LeftButton)


def grains_seen(view):
    """How much of the picture of a slice is not grey."""
    image = view.canvas.grab().toImage()
    colours = [
        image.pixelColor(x, y) for x in range(0, image.width(), 9) for y in range(0, image.height(), 9)
    ]
    return np.mean([colour.hsvSaturation() > 60 for colour in colours])


def paint(view, corners):
    """Draw a line through voxels of the slice, (across, down), with the mouse."""
    edges = page_edges(view)

    def at(corner):
        scene = view.canvas.view.mapViewToScene(QPointF(*((np.array(corner) + 0.5) * edges)))
        return view.canvas.mapFromScene(scene)

    target = view.canvas.viewport()
    QTest.mousePress(target, Qt.MouseButton.LeftButton, pos=at(corners[0]))
    for corner in corners[1:]:
        QTest.mouseMove(target, at(corner))
    QTest.mouseRelease(target, Qt.MouseButton.LeftButton, pos=at(corners[-1]))


def page_edges(view):
    return view._volume.voxel_size[[view.across, view.down]]


def click_voxel(view, across, down):
    scene = view.canvas.view.mapViewToScene(QPointF(*((np.array([across, down]) + 0.5) * page_edges(view))))
    target = view.canvas.viewport()
    QTest.mouseClick(target, Qt.MouseButton.LeftButton, pos=view.canvas.mapFromScene(scene))
