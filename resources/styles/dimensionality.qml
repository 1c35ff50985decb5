<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>
<qgis styleCategories="Symbology|Symbology3D" version="3.40.0" sync3DRendererTo2DRenderer="1">
  <renderer type="classified" attribute="Dimensionality" pointSize="0.8" pointSizeUnit="MM" pointSizeMapUnitScale="3x:0,0,0,0,0,0" maximumScreenError="0.3" maximumScreenErrorUnit="MM" pointSymbol="1" drawOrder2d="1" renderAsTriangles="0" horizontalTriangleFilter="0" horizontalTriangleFilterThreshold="5" horizontalTriangleFilterUnit="MM">
    <categories>
      <category value="0" label="Undefined" color="200,200,200,255" pointSize="0" render="true"/>
      <category value="1" label="Linear" color="213,94,0,255" pointSize="0" render="true"/>
      <category value="2" label="Planar" color="0,158,115,255" pointSize="0" render="true"/>
      <category value="3" label="Volumetric" color="0,114,178,255" pointSize="0" render="true"/>
    </categories>
  </renderer>
  <blendMode>0</blendMode>
</qgis>
