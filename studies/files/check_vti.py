"""Reads a .vti file with VTK and compares it with the .npy arrays beside it.

    pip install vtk numpy
    python check_vti.py FILE.vti NAME=ARRAY.npy ...
"""

import sys

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLImageDataReader

reader = vtkXMLImageDataReader()
reader.SetFileName(sys.argv[1])
reader.Update()
image = reader.GetOutput()
nx, ny, _ = (n - 1 for n in image.GetDimensions())
print("cells", nx, ny, "spacing", image.GetSpacing())
for argument in sys.argv[2:]:
    name, file = argument.split("=", 1)
    found = vtk_to_numpy(image.GetCellData().GetArray(name)).reshape((ny, nx)).T
    expected = np.load(file)
    assert np.array_equal(found, expected, equal_nan=True), name
    print(name, "is the same,", found.shape)
