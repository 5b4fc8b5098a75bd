"""ParaView reads archives of Tessera: Tools > Manage Plugins > Load New..., and choose this file. The package `tessera`
must be on the PYTHONPATH of ParaView (it is where the Debian package is installed)."""
from paraview.util.vtkAlgorithm import smdomain, smhint, smproperty, smproxy

from tessera.vtk_reader import TesseraReader as Reader


@smproxy.reader(name="TesseraReader", label="Tessera archive", extensions="tsr", file_description="Tessera archives")
class TesseraReader(Reader):
    @smproperty.stringvector(name="FileName")
    @smdomain.filelist()
    @smhint.filechooser(extensions="tsr", file_description="Tessera archives")
    def SetFileName(self, path):
        super().SetFileName(path)

    @smproperty.intvector(name="Level", default_values=0)
    @smdomain.intrange(min=0, max=8)
    def SetLevel(self, level):
        """Level of detail: 0 is every sample, each further one half of them along each axis."""
        super().SetLevel(level)

    @smproperty.doublevector(name="TimestepValues", information_only="1", si_class="vtkSITimeStepsProperty")
    def GetTimestepValues(self):
        return super().GetTimestepValues()

    @smproperty.dataarrayselection(name="Arrays")
    def GetDataArraySelection(self):
        return super().GetDataArraySelection()
