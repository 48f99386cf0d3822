"""Nodes of a CGNS tree, as h5py writes them."""
import numpy as np


def node(parent, name, label, letters="MT", data=None):
    group = parent.create_group(name)
    for key, text, size in (("name", name, 33), ("label", label, 33), ("type", letters, 3)):
        group.attrs.create(key, np.bytes_(text), dtype=f"S{size}")
    group.attrs.create("flags", np.array([1], "i4"))
    if data is not None:
        group.create_dataset(" data", data=data)
    return group


def text(parent, name, label, content):
    return node(parent, name, label, "C1", np.frombuffer(content.encode(), "i1"))
