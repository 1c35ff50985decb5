<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>
<qgis styleCategories="Symbology|Symbology3D" version="3.40.0" sync3DRendererTo2DRenderer="1">
  <renderer type="classified" attribute="Reason" pointSize="0.8" pointSizeUnit="MM" pointSizeMapUnitScale="3x:0,0,0,0,0,0" maximumScreenError="0.3" maximumScreenErrorUnit="MM" pointSymbol="1" drawOrder2d="1" renderAsTriangles="0" horizontalTriangleFilter="0" horizontalTriangleFilterThreshold="5" horizontalTriangleFilterUnit="MM">
    <categories>
      <category value="0" label="Not looked at" color="221,221,221,255" pointSize="0" render="true"/>
      <category value="1" label="Building: plane" color="0,68,136,255" pointSize="0" render="true"/>
      <category value="2" label="Building: solid plane" color="0,68,136,255" pointSize="0" render="true"/>
      <category value="3" label="Building: solid" color="102,153,204,255" pointSize="0" render="true"/>
      <category value="4" label="Building: attached" color="170,200,230,255" pointSize="0" render="true"/>
      <category value="5" label="Building: next to buildings" color="51,119,187,255" pointSize="0" render="true"/>
      <category value="7" label="Building: surface" color="17,119,136,255" pointSize="0" render="true"/>
      <category value="8" label="Building: like buildings" color="136,221,238,255" pointSize="0" render="true"/>
      <category value="9" label="Building: kept" color="0,153,136,255" pointSize="0" render="true"/>
      <category value="11" label="Not a building: rough" color="221,170,51,255" pointSize="0" render="true"/>
      <category value="12" label="Not a building: penetrated" color="153,119,0,255" pointSize="0" render="true"/>
      <category value="13" label="Not a building: into ground" color="170,136,119,255" pointSize="0" render="true"/>
      <category value="14" label="Not a building: too small" color="238,153,170,255" pointSize="0" render="true"/>
      <category value="16" label="Not a building: too low" color="153,68,85,255" pointSize="0" render="true"/>
      <category value="17" label="Not a building: mostly other" color="119,51,68,255" pointSize="0" render="true"/>
      <category value="18" label="Not a building: amid others" color="136,34,85,255" pointSize="0" render="true"/>
      <category value="19" label="Not a building: green" color="102,119,34,255" pointSize="0" render="true"/>
      <category value="20" label="Not a building: vehicle" color="170,68,153,255" pointSize="0" render="true"/>
      <category value="21" label="Undecided: alike" color="120,120,120,255" pointSize="0" render="true"/>
      <category value="22" label="Undecided: without entropy" color="80,80,80,255" pointSize="0" render="true"/>
      <category value="23" label="Not a building: unlike buildings" color="238,119,51,255" pointSize="0" render="true"/>
      <category value="24" label="Not a building: deleted" color="204,51,17,255" pointSize="0" render="true"/>
      <category value="25" label="Not a building: by chance" color="119,119,51,255" pointSize="0" render="true"/>
    </categories>
  </renderer>
  <blendMode>0</blendMode>
</qgis>
